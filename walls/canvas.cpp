// SPDX-License-Identifier: Apache-2.0
#include "walls/canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace walls {
namespace {

/// Returns the distance between the starts of neighbouring tiles, across and down [pixel].
glm::dvec2 pitchInPixels(const Grid& grid) {
    return (grid.tileSize + grid.bezel) / grid.tileSize * glm::dvec2(grid.tilePixels);
}

int nearest(double pixels) { return static_cast<int>(std::lround(pixels)); }

}  // namespace

Canvas wallCanvas(const Wall& wall) {
    Canvas canvas;
    canvas.tiles.resize(wall.tiles.size());
    int right = 0;  // right end of the tiles so far
    for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
        const Tile& tile = wall.tiles[i];
        PixelRect& rect = canvas.tiles[i];
        rect.width = tile.pixels.x;
        rect.height = tile.pixels.y;
        if (tile.row > 0 && wall.grid) {
            const glm::dvec2 pitch = pitchInPixels(*wall.grid);
            rect.x = nearest(pitch.x * (tile.column - 1));
            rect.y = nearest(pitch.y * (tile.row - 1));
        } else {
            rect.x = right == 0 ? 0 : right + kScreenGap;
        }
        right = std::max(right, rect.x + rect.width);
        canvas.height = std::max(canvas.height, rect.y + rect.height);
    }
    canvas.width = right;
    for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
        if (wall.tiles[i].row == 0) {
            canvas.tiles[i].y = canvas.height - canvas.tiles[i].height;
        }
    }
    return canvas;
}

Wall wholeWall(const Wall& wall) {
    const bool explicitScreens =
        std::any_of(wall.tiles.begin(), wall.tiles.end(), [](const Tile& t) { return t.row == 0; });
    if (!wall.grid || explicitScreens) {
        throw std::invalid_argument(fmt::format("wall '{}' is not one grid: it has no single extent", wall.name));
    }
    const Grid& grid = *wall.grid;
    const glm::dvec2 bezelPixels = pitchInPixels(grid) - glm::dvec2(grid.tilePixels);
    if (glm::distance(bezelPixels, glm::round(bezelPixels)) > 1e-6) {
        throw std::invalid_argument(fmt::format("bezels of wall '{}' are {} x {} pixels, which is not whole", wall.name,
                                                bezelPixels.x, bezelPixels.y));
    }
    const Canvas canvas = wallCanvas(wall);
    if (canvas.width > kMaxTileSide || canvas.height > kMaxTileSide) {
        throw std::invalid_argument(
            fmt::format("wall '{}' as one tile would have {}x{} pixels", wall.name, canvas.width, canvas.height));
    }
    Wall whole = wall;
    whole.grid->rows = whole.grid->columns = 1;
    whole.grid->bezel = glm::dvec2(0);
    whole.grid->tilePixels = {canvas.width, canvas.height};
    whole.grid->tileSize = grid.tileSize * glm::dvec2(whole.grid->tilePixels) / glm::dvec2(grid.tilePixels);
    whole.tiles = tilesOf(*whole.grid, wall.stereo);
    return whole;
}

}  // namespace walls
