// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/contour.hpp"
#include "sand/model/tool_shape.hpp"

namespace sand::force {

/// The tool's control points as it is turned now, evenly along its outline; that of a footprint goes
/// straight from toe to toe. Asked after every step, not at every tick.
[[nodiscard]] Contour contourOf(const ToolShape& shape, const Heading& heading, double cellSize /* [scene unit] */);

}  // namespace sand::force
