// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "walls/wall.hpp"

namespace walls {

/// Pixels of a picture whose row 0 is the top.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// Where each tile's picture goes in one picture of the whole wall.
struct Canvas {
    int width = 0, height = 0;     // [pixel]
    std::vector<PixelRect> tiles;  // in the order of ranks: tiles[rank - 1]
};

/// Lays the tiles out for a picture of the wall: the grid as it stands, bezels included, each tile at the nearest whole
/// pixel of its true place; explicit screens to the right of it, side by side in the order of ranks, bottoms aligned,
/// kScreenGap apart. What no tile covers stays black.
[[nodiscard]] Canvas wallCanvas(const Wall& wall);

inline constexpr int kScreenGap = 16;  // [pixel]

/// The same display as one tile that covers the whole extent of the grid at the same pixel density, bezels and all:
/// tile `rank` of the wall must look like the crop of the one picture at wallCanvas(wall).tiles[rank - 1].
/// Throws std::invalid_argument when the wall has explicit screens, a bezel is not a whole number of pixels, or the
/// one tile would be larger than kMaxTileSide.
[[nodiscard]] Wall wholeWall(const Wall& wall);

}  // namespace walls
