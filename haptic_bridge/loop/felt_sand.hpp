// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/loop/haptic_tick.hpp"
#include "sand/force/tool_contour.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// What a hand feels of the sand after the terrain's last step, but for the time: one way to make it, for whoever makes
/// steps and for whoever replays them.
inline void takeSurface(const sand::Replica& terrain, FeltSand& surface) {
    surface.patch.take(terrain, terrain.probe());
    surface.tool = sand::force::contourOf(terrain.toolShape(), terrain.heading(), terrain.cellSize());
    surface.step = terrain.stepNumber();
}

}  // namespace haptic_bridge
