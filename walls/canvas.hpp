// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "walls/wall.hpp"

namespace walls {

/// Rectangle of pixels in a picture whose row 0 is the top.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// Places of all tiles' pictures in one picture of the whole wall.
struct Canvas {
    int width = 0, height = 0;     // [pixel]
    std::vector<PixelRect> tiles;  // in the order of ranks: tiles[rank - 1]
};

/// Lays out the tiles for a picture of the whole wall.
///
/// The grid keeps its shape, bezels included; each tile is at the nearest whole pixel to its true place. Explicit
/// screens are to the right of the grid, side by side in the order of ranks, kScreenGap apart, with their bottoms
/// aligned. The area between tiles is black.
[[nodiscard]] Canvas wallCanvas(const Wall& wall);

inline constexpr int kScreenGap = 16;  // [pixel]

/// Returns the same display as one tile that covers the whole grid, bezels included, with the same pixel density.
///
/// Tile `rank` of the wall must look like the part wallCanvas(wall).tiles[rank - 1] of that tile's picture. Throws
/// std::invalid_argument if the wall has explicit screens or if a bezel is not a whole number of pixels. Also throws it
/// if the one tile would be larger than kMaxTileSide.
[[nodiscard]] Wall wholeWall(const Wall& wall);

}  // namespace walls
