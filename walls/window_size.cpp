// SPDX-License-Identifier: Apache-2.0
#include "walls/window_size.hpp"

#include <algorithm>

namespace walls {

bool followsWindow(const Wall& wall) {
    return wall.tiles.size() == 1 && wall.tiles[0].outputs.size() == 1 && !isPlaced(wall.tiles[0].outputs[0]);
}

Wall shownInWindow(Wall wall, glm::ivec2 window) {
    if (window == glm::ivec2(0)) {
        return wall;
    }
    Tile& tile = wall.tiles.at(0);
    Screen& screen = tile.screen;
    const glm::dvec2 size(screen.width(), screen.height());
    const glm::dvec2 pixelSize = size / glm::dvec2(tile.pixels);
    const glm::ivec2 eyes = outputPixels(wall.stereo, glm::ivec2(1));  // eyes in one buffer, across and down
    tile.pixels = glm::clamp(window / eyes, glm::ivec2(kLeastWindowSide), kMaxTileSide / eyes);
    // The smallest rectangle with the shape of the window that covers the screen in the wall file.
    const glm::dvec2 wanted = glm::dvec2(tile.pixels) * pixelSize;
    const glm::dvec2 grown = wanted * std::max(size.x / wanted.x, size.y / wanted.y);
    const glm::dvec3 right = screen.right(), up = screen.up();
    screen.lowerLeft -= right * ((grown.x - size.x) / 2) + up * ((grown.y - size.y) / 2);
    screen.lowerRight = screen.lowerLeft + right * grown.x;
    screen.upperLeft = screen.lowerLeft + up * grown.y;
    if (wall.grid) {
        wall.grid->tilePixels = tile.pixels;
        wall.grid->tileSize = grown;
        wall.grid->lowerLeft = screen.lowerLeft;
    }
    return wall;
}

std::int64_t frameBufferBytes(const Wall& wall, const Tile& tile) {
    const auto area = [](glm::ivec2 pixels) { return std::int64_t{pixels.x} * pixels.y; };
    constexpr std::int64_t kColour = 4, kDepth = 4;  // [byte] of a pixel
    const auto eyes = static_cast<std::int64_t>(eyesOf(wall.stereo).size());
    const auto outputs = static_cast<std::int64_t>(tile.outputs.size());
    const std::int64_t shown = area(outputPixels(wall.stereo, tile.pixels));
    const std::int64_t packed = packsEyes(wall.stereo) ? kColour * shown : 0;
    const std::int64_t buffers = wall.stereo == Stereo::active ? 2 * kColour : kColour;  // of a window
    return (kColour + kDepth) * eyes * area(tile.pixels) + packed + buffers * outputs * shown;
}

}  // namespace walls
