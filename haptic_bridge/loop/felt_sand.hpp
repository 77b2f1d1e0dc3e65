// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/loop/haptic_tick.hpp"
#include "sand/force/tool_contour.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// Fills in what a hand at `around` feels of the sand after the terrain's last step, but for the time. The thread that
/// makes steps and a replay both call this.
inline void takeSurface(const sand::Replica& terrain, const sand::ProbePoint& around, FeltSand& surface) {
    surface.patch.take(terrain, around);
    surface.around = {around.x, around.y, 0};
    surface.tool = sand::force::contourOf(terrain.toolShape(), terrain.heading(), terrain.cellSize());
    surface.step = terrain.stepNumber();
}

}  // namespace haptic_bridge
