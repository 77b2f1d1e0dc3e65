// SPDX-License-Identifier: Apache-2.0
#include "master/measure/slowest_host.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string_view>

namespace master {

namespace {

/// Returns the time [ns] of the middle rank; of two in the middle, the longer one. Changes the order of `ranks`.
std::int64_t median(std::vector<const lockstep::Arrival*>& ranks, std::int64_t lockstep::Arrival::*time) {
    const auto middle = ranks.begin() + static_cast<std::ptrdiff_t>(ranks.size() / 2);
    std::ranges::nth_element(ranks, middle, {}, [time](const lockstep::Arrival* rank) { return rank->*time; });
    return (*middle)->*time;
}

}  // namespace

haptic_bridge::FrameCost costOf(const std::vector<lockstep::Arrival>& arrivals,
                                const std::vector<lockstep::RankHost>& hosts) {
    haptic_bridge::FrameCost cost;
    std::map<std::string_view, std::vector<const lockstep::Arrival*>> machines;
    for (std::size_t rank = 0; rank < arrivals.size(); ++rank) {
        machines[hosts.at(rank).machine].push_back(&arrivals[rank]);
        cost.drawNs = std::max(cost.drawNs, arrivals[rank].drawn);
    }
    for (auto& [machine, ranks] : machines) {
        cost.dragNs = std::max(cost.dragNs, median(ranks, &lockstep::Arrival::dragged));
        cost.phaseNs = std::max(cost.phaseNs, median(ranks, &lockstep::Arrival::slid));
        cost.sweepNs = std::max(cost.sweepNs, median(ranks, &lockstep::Arrival::swept));
        cost.hashNs = std::max(cost.hashNs, median(ranks, &lockstep::Arrival::hashed));
    }
    return cost;
}

}  // namespace master
