// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "walls/wall.hpp"

namespace walls {

/// Returns a map of the wall in text. It shows the grid as the viewer sees it, and below it the explicit screens. The
/// screens are unfolded along the edges where they join, like a flattened paper room. A box has the rank and, for
/// screens, the name. Turned grids and screens are shown in the nearest quarter turn, with a line about their angle.
[[nodiscard]] std::string textMap(const Wall& wall);

using MapCell = std::pair<int, int>;  // row from the top, column; they may be negative
/// Returns the cell of each explicit screen in the map, by its index in wall.tiles.
[[nodiscard]] std::map<std::size_t, MapCell> unfolded(const Wall& wall);

}  // namespace walls
