// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "render_node/surface/drawn_surface.hpp"

namespace render_node {

/// Returns the surface of this sand in GL. `sun` points towards the sun and has length 1. `stepsPerSecond` says for how
/// many steps sand counts as moving. The GL context must be current.
[[nodiscard]] std::unique_ptr<DrawnSurface> makeDrawnSurface(const sand::SurfaceData& data,
                                                             double cellSize /* [scene unit] */, const glm::vec3& sun,
                                                             int stepsPerSecond);

}  // namespace render_node
