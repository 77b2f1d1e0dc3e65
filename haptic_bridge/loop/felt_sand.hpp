// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/loop/haptic_tick.hpp"
#include "sand/force/tool_contour.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// Fills `surface` with the sand that a hand at `probe` feels after the last step of `replica`. Sets neither its times
/// nor its number of edits. Both the thread that makes steps and a replay call this function.
inline void takeSurface(const sand::Replica& replica, const sand::ProbePoint& probe, FeltSand& surface) {
    surface.patch.take(replica.surface(), replica.rules(), replica.cellSize(), probe);
    surface.probe = {probe.x, probe.y, 0};
    surface.tool = sand::force::contourOf(replica.tool(), replica.cellSize());
    surface.talus = static_cast<double>(replica.rules().tuning.threshold) / sand::kUnitsPerCell;
    surface.step = replica.stepNumber();
}

}  // namespace haptic_bridge
