// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/pointer_arbiter.hpp"

#include <algorithm>

namespace haptic_bridge {

std::optional<std::size_t> PointerArbiter::hand(std::span<const PointerReport> reports) {
    std::erase_if(touches_, [&](const Touch& touch) {
        return touch.rank >= reports.size() || !reports[touch.rank].touches() ||
               reports[touch.rank].touch != touch.number;
    });
    for (std::size_t rank = 0; rank < reports.size(); ++rank) {
        const bool known =
            std::any_of(touches_.begin(), touches_.end(), [&](const Touch& touch) { return touch.rank == rank; });
        if (reports[rank].touches() && !known) {
            touches_.push_back({rank, reports[rank].touch});
        }
    }
    if (!touches_.empty()) {
        last_ = touches_.front().rank;
        return last_;
    }
    const auto moved =
        std::find_if(reports.begin(), reports.end(), [](const auto& report) { return report.count > 0; });
    if (moved != reports.end()) {
        last_ = static_cast<std::size_t>(moved - reports.begin());
    }
    return last_;
}

}  // namespace haptic_bridge
