// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
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

/// Returns one line for each sign that the lengths of a wall are in another unit than metres. The signs are a pixel
/// above kMaxPixel, and a stage beyond the far plane of every tile. Such a wall can be drawn, and usually has one
/// colour.
[[nodiscard]] std::vector<std::string> unitWarnings(const Wall& wall);
/// Returns a line if no tile shows a corner of the sand. That may be meant on a wall that shows the middle of the sand.
[[nodiscard]] std::optional<std::string> stageWarning(const Wall& wall);

}  // namespace walls
