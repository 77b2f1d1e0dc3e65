// SPDX-License-Identifier: Apache-2.0
#include "lockstep/wall_figures.hpp"

namespace lockstep {

void WallFigures::encode(base::ByteWriter& writer) const {
    writer.put(frameMs);
    writer.put(static_cast<std::uint8_t>(slowest ? 1 : 0));
    if (slowest) {
        writer.putVarint(static_cast<std::uint64_t>(slowest->rank));
        writer.put(slowest->share);
        writer.put(slowest->keptMs);
    }
    writer.putVarint(agreed);
    writer.putVarint(divergences);
    writer.putVarint(healed);
    writer.putVarint(swaps.size());
    for (const std::uint32_t swap : swaps) {
        writer.putVarint(swap);
    }
}

WallFigures WallFigures::decode(base::ByteReader& reader) {
    WallFigures figures;
    figures.frameMs = reader.get<double>();
    if (reader.get<std::uint8_t>() != 0) {
        Drag& drag = figures.slowest.emplace();
        drag.rank = static_cast<int>(reader.getVarint());
        drag.share = reader.get<double>();
        drag.keptMs = reader.get<double>();
    }
    figures.agreed = reader.getVarint();
    figures.divergences = reader.getVarint();
    figures.healed = reader.getVarint();
    const std::uint64_t swaps = reader.getVarint();
    for (std::uint64_t i = 0; i < swaps; ++i) {
        figures.swaps.push_back(static_cast<std::uint32_t>(reader.getVarint()));
    }
    return figures;
}

}  // namespace lockstep
