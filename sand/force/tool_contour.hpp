// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/contour.hpp"
#include "sand/model/tool_shape.hpp"

namespace sand::force {

/// Returns the tool's control points with its current heading, spaced evenly along its outline. The outline of a
/// footprint goes straight from toe to toe. Called after every step, not at every tick.
[[nodiscard]] Contour contourOf(const ToolShape& shape, const Heading& heading, double cellSize /* [scene unit] */);

}  // namespace sand::force
