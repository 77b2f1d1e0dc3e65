// SPDX-License-Identifier: Apache-2.0
#include "lockstep/view_agreement.hpp"

#include <fmt/format.h>
#include <xxhash.h>

namespace lockstep {

ViewProof::ViewProof(std::span<const std::uint8_t> wall) : wall_(XXH3_64bits(wall.data(), wall.size())) {}

std::uint64_t ViewProof::hash(const ViewState& view) const {
    const base::Bytes bytes = base::encoded(view);
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), wall_);
}

std::vector<std::string> describeOtherViews(const std::vector<Arrival>& arrivals,
                                            const std::vector<std::string>& names) {
    std::vector<std::string> lines;
    const Arrival& master = arrivals.front();
    for (std::size_t rank = 1; rank < arrivals.size(); ++rank) {
        if (arrivals[rank].viewHash != master.viewHash) {
            lines.push_back(
                fmt::format("frame {}: {} drew another view of the wall than the master sent: {:016x} and "
                            "not {:016x}; head, eyes, stage and wall file must be the same on every rank",
                            master.frame, names[rank], arrivals[rank].viewHash, master.viewHash));
        }
    }
    return lines;
}

}  // namespace lockstep
