// SPDX-License-Identifier: Apache-2.0
#include "lockstep/healing.hpp"

#include <algorithm>

namespace lockstep {

base::Bytes Remedy::encode() const {
    base::ByteWriter writer;
    writer.put(static_cast<std::uint8_t>(goOn ? 1 : 0));
    writer.put(source);
    writer.putVarint(odd.size());
    for (const int rank : odd) {
        writer.put(rank);
    }
    return writer.take();
}

Remedy Remedy::decode(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    Remedy remedy;
    remedy.goOn = reader.get<std::uint8_t>() != 0;
    remedy.source = reader.get<int>();
    const std::uint64_t count = reader.getVarint();
    for (std::uint64_t i = 0; i < count; ++i) {
        remedy.odd.push_back(reader.get<int>());
    }
    return remedy;
}

Healing heal(FrameBarrier& barrier, sand::Replica& terrain, const Remedy& fromMaster) {
    const Remedy remedy = Remedy::decode(barrier.tellAll(fromMaster.encode()));
    if (!remedy.goOn) {
        return Healing::ended;
    }
    const int rank = barrier.cluster().rank();
    const bool odd = std::find(remedy.odd.begin(), remedy.odd.end(), rank) != remedy.odd.end();
    if (!remedy.odd.empty()) {
        const bool gives = rank == remedy.source;
        const base::Bytes state =
            barrier.pass(remedy.source, remedy.odd, gives ? terrain.encodeState() : base::Bytes());
        if (odd) {
            terrain.decodeState(state);
        }
    }
    terrain.audit(terrain.hashTiles().tileCount());
    return odd ? Healing::healed : Healing::spared;
}

}  // namespace lockstep
