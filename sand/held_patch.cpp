// SPDX-License-Identifier: Apache-2.0
#include "sand/held_patch.hpp"

#include <algorithm>

namespace sand {
namespace {

/// Heights as the slope law shall see them. Beyond the rim the ground goes on as it came, unless a wall is in the way.
std::int32_t seenHeight(const HeightField& field, const Ground& ground, int x, int y) {
    const int edgeX = std::clamp(x, 0, field.columns() - 1);
    const int edgeY = std::clamp(y, 0, field.rows() - 1);
    if (ground.isWall(edgeX, edgeY)) {
        return kMaxHeight;
    }
    const int innerX = std::clamp(2 * edgeX - x, 0, field.columns() - 1);
    const int innerY = std::clamp(2 * edgeY - y, 0, field.rows() - 1);
    const std::int32_t edge = field.height(edgeX, edgeY);
    return ground.isWall(innerX, innerY) ? edge : 2 * edge - field.height(innerX, innerY);
}

}  // namespace

HeldPatch::HeldPatch(const HeightField& field, const Rect& cells, const Ground* ground, const Obstacle* obstacle) {
    const Rect grown = cells.grownBy(1);
    const int width = grown.x1 - grown.x0;
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(grown.y1 - grown.y0);
    const auto index = [&](int x, int y) {
        return static_cast<std::size_t>(y - grown.y0) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x - grown.x0);
    };
    room.assign(count, Obstacle::kFree);
    if (ground != nullptr) {
        heights.resize(count);
        sand.resize(count);
        for (int y = grown.y0; y < grown.y1; ++y) {
            for (int x = grown.x0; x < grown.x1; ++x) {
                const int inX = std::clamp(x, 0, field.columns() - 1);
                const int inY = std::clamp(y, 0, field.rows() - 1);
                heights[index(x, y)] = seenHeight(field, *ground, x, y);
                sand[index(x, y)] = ground->sand(inX, inY, field.height(inX, inY));
                if (ground->isWall(inX, inY)) {
                    room[index(x, y)] = 0;
                }
            }
        }
    }
    if (obstacle != nullptr) {
        const Rect shared = obstacle->cells.clippedTo(grown);
        for (int y = shared.y0; y < shared.y1; ++y) {
            for (int x = shared.x0; x < shared.x1; ++x) {
                const std::int32_t underside = obstacle->at(x, y);
                if (underside != Obstacle::kFree) {
                    // Four faces may each bring a quarter of what fits under the tool.
                    std::int32_t& room4 = room[index(x, y)];
                    room4 = std::min(room4, std::max(underside - field.height(x, y), 0) / 4);
                }
            }
        }
    }
}

}  // namespace sand
