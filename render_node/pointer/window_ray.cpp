// SPDX-License-Identifier: Apache-2.0
#include "render_node/pointer/window_ray.hpp"

#include <optional>

#include "walls/x_screen.hpp"

namespace render_node {
namespace {

/// Returns the place in an eye's picture for a place in its output's buffer. Both are shares of the side, from the top
/// left. A buffer that packs both eyes shows each place of the picture twice.
glm::dvec2 pictureShare(walls::Stereo stereo, glm::dvec2 share) {
    const auto unpacked = [](double packed) { return packed < 0.5 ? 2 * packed : 2 * packed - 1; };
    if (stereo == walls::Stereo::sideBySide) {
        share.x = unpacked(share.x);
    } else if (stereo == walls::Stereo::topBottom) {
        share.y = unpacked(share.y);
    }
    return share;
}

glm::dvec3 onScreen(const walls::Wall& wall, const walls::Tile& tile, glm::dvec2 pixel) {
    const glm::dvec2 size(walls::outputPixels(wall.stereo, tile.pixels));
    const glm::dvec2 share = pictureShare(wall.stereo, pixel / size);
    const walls::Screen& screen = tile.screen;
    return screen.lowerLeft + share.x * (screen.lowerRight - screen.lowerLeft) +
           (1 - share.y) * (screen.upperLeft - screen.lowerLeft);
}

bool contains(glm::dvec2 size, glm::dvec2 pixel) {
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x < size.x && pixel.y < size.y;
}

}  // namespace

glm::dvec3 roomPoint(const walls::Wall& wall, const walls::Tile& tile, const WindowPlace& place) {
    const std::optional<glm::ivec2>& corner = tile.outputs.at(place.output).window;
    if (corner && !contains(walls::outputPixels(wall.stereo, tile.pixels), place.at)) {
        for (const walls::Tile& other : wall.tiles) {
            const bool sameDisplay = walls::xScreenOf(other.place) == walls::xScreenOf(tile.place);
            for (const walls::Output& output : other.outputs) {
                if (sameDisplay && output.window) {
                    const glm::dvec2 there = place.at + glm::dvec2(*corner - *output.window);
                    if (contains(walls::outputPixels(wall.stereo, other.pixels), there)) {
                        return onScreen(wall, other, there);
                    }
                }
            }
        }
    }
    return onScreen(wall, tile, place.at);
}

Ray sightRay(glm::dvec3 eye, glm::dvec3 point, const glm::dmat4& sceneToRoom) {
    const glm::dmat4 toScene = glm::inverse(sceneToRoom);
    const glm::dvec3 from(toScene * glm::dvec4(eye, 1));
    return {from, glm::dvec3(toScene * glm::dvec4(point, 1)) - from};
}

}  // namespace render_node
