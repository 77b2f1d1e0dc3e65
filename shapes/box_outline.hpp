// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

#include "shapes/model/box.hpp"

namespace shapes {

// Measures of the box around the sand [share of the field's longer side].
inline constexpr float kBoardThickness = 0.015F;  // of boards and floor
inline constexpr float kFloorDepth = 0.06F;       // of the floor below the lowest sand
inline constexpr float kBoardRise = 0.006F;       // of the boards above the highest sand at the rim, at most

/// Returns a box around a field of sand with its boards and its floor. `field` is its width and depth, and the sand is
/// from `lowest` to `highest`, all in scene units. SandBox is within it, because its boards are at most kBoardRise
/// above the sand.
[[nodiscard]] inline Box boxOutline(glm::dvec2 field, double lowest, double highest) {
    const double length = std::max(field.x, field.y);
    const double thick = double{kBoardThickness} * length;
    return {{-thick, -thick, lowest - double{kFloorDepth} * length - thick},
            {field.x + thick, field.y + thick, highest + double{kBoardRise} * length}};
}

}  // namespace shapes
