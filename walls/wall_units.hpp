// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "walls/wall.hpp"

namespace walls {

inline constexpr double kMaxPixel = 0.02;  // [m], side of a pixel; those of LED walls for halls have up to 16 mm

/// Returns the corners of the sand in the room [m], taken as a square field: south-west, south-east, north-west,
/// north-east.
[[nodiscard]] std::array<glm::dvec3, 4> stageCorners(const Stage& stage);
/// Returns the names of the tiles on which the midpoint of the eyes sees a point of the room.
[[nodiscard]] std::vector<std::string> tilesShowing(const Wall& wall, glm::dvec3 point /* [m] */);

/// Returns one line for each sign that the lengths of a wall are in another unit than metres: a pixel above kMaxPixel,
/// a stage beyond the far clipping plane of every tile, and sand of which no tile shows a corner.
///
/// Such a wall can be drawn, and all its tiles usually have one colour. Pure.
[[nodiscard]] std::vector<std::string> unitWarnings(const Wall& wall);

}  // namespace walls
