// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/contour.hpp"
#include "sand/tool_shape.hpp"

namespace sand::force {

/// The tool's control points as it is turned now, evenly along its outline from where it heads on; those of a
/// footprint lie on the outline as seen from its middle, toes and all. Asked after every step, not at every tick.
[[nodiscard]] Contour contourOf(const ToolShape& shape, const Heading& heading, double cellSize /* [scene unit] */);

}  // namespace sand::force
