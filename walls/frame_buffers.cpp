// SPDX-License-Identifier: Apache-2.0
#include "walls/frame_buffers.hpp"

namespace walls {
namespace {

std::int64_t area(glm::ivec2 pixels) { return std::int64_t{pixels.x} * pixels.y; }

}  // namespace

std::int64_t frameBufferBytes(const Wall& wall, const Tile& tile) {
    constexpr std::int64_t kColour = 4, kDepth = 4;  // [byte] of a pixel
    const auto eyes = static_cast<std::int64_t>(eyesOf(wall.stereo).size());
    const auto outputs = static_cast<std::int64_t>(tile.outputs.size());
    const std::int64_t shown = area(outputPixels(wall.stereo, tile.pixels));
    const std::int64_t packed = packsEyes(wall.stereo) ? kColour * shown : 0;
    const std::int64_t buffers = wall.stereo == Stereo::active ? 2 * kColour : kColour;  // of a window
    return (kColour + kDepth) * eyes * area(tile.pixels) + packed + buffers * outputs * shown;
}

}  // namespace walls
