// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "haptic_bridge/hand/frame_cost.hpp"
#include "lockstep/arrival.hpp"
#include "lockstep/host_memory.hpp"

namespace master {

/// Returns the wall times of the sand and of the drawing in a frame whose ranks have sent `arrivals`; its work is 0.
/// Both lists have an element a rank.
///
/// The cost of the sand is that of the slowest host. On a host it is the median of the ranks, because they all compute
/// the same. If more ranks than cores share a host, some ranks are interrupted in each frame. The longest time then
/// says nothing about the work.
[[nodiscard]] haptic_bridge::FrameCost costOf(const std::vector<lockstep::Arrival>& arrivals,
                                              const std::vector<lockstep::RankHost>& hosts);

}  // namespace master
