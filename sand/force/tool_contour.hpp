// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/contour.hpp"
#include "sand/model/tool.hpp"

namespace sand::force {

/// Returns the tool's control points, spaced evenly along its outline. The outline of a
/// footprint goes straight from toe to toe. Called after every step, not at every tick.
[[nodiscard]] Contour contourOf(const Tool& tool, double cellSize /* [scene unit] */);

}  // namespace sand::force
