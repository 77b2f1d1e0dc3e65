// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "walls/projection.hpp"

namespace walls {
namespace {

constexpr const char* kAdvice = "all lengths of a wall file are in metres";

/// Returns the shorter side of a pixel [m]. The longer one may be twice as long, where a display stretches halves.
double pixelSide(const Tile& tile) {
    return std::min(tile.screen.width() / tile.pixels.x, tile.screen.height() / tile.pixels.y);
}

/// Returns the least distance of a point from the eye along the normal of a tile [m]. Tiles that have the point behind
/// the eye do not count. Infinite if none is left.
double leastDepth(const Wall& wall, glm::dvec3 point) {
    double least = HUGE_VAL;
    for (const Tile& tile : wall.tiles) {
        const double depth = tile.screen.distanceTo(wall.viewer.eye) - tile.screen.distanceTo(point);
        least = depth > 0 ? std::min(least, depth) : least;
    }
    return least;
}

}  // namespace

std::array<glm::dvec3, 4> stageCorners(const Stage& stage) {
    const glm::dmat4 toRoom = stageToRoom(stage, 1, 1, 0);
    const auto at = [&](double east, double north) { return glm::dvec3(toRoom * glm::dvec4(east, north, 0, 1)); };
    return {at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
}

std::vector<std::string> tilesShowing(const Wall& wall, glm::dvec3 point) {
    std::vector<std::string> names;
    for (const Tile& tile : wall.tiles) {
        const glm::dvec4 c = viewOf(wall, tile, Eye::middle).viewProjection * glm::dvec4(point, 1);
        if (c.w > 0 && std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) <= c.w) {
            names.push_back(tile.name);
        }
    }
    return names;
}

std::vector<std::string> unitWarnings(const Wall& wall) {
    std::vector<std::string> lines;
    const auto largest = std::ranges::max_element(wall.tiles, {}, pixelSide);
    if (const double side = pixelSide(*largest); side > kMaxPixel) {
        lines.push_back(fmt::format("a pixel of tile '{}' is {:.0f} mm wide, and more than {:.0f} mm is unusual; {}",
                                    largest->name, side * 1000, kMaxPixel * 1000, kAdvice));
    }
    double nearest = leastDepth(wall, wall.stage.centre);
    for (const glm::dvec3 corner : stageCorners(wall.stage)) {
        nearest = std::min(nearest, leastDepth(wall, corner));
    }
    if (nearest > wall.clip.far && nearest < HUGE_VAL) {
        lines.push_back(
            fmt::format("the sand is {:.4g} m from the eye, beyond far ({:.4g} m), so that nothing of it is "
                        "drawn; {}, or move [stage] or far of [clip]",
                        nearest, wall.clip.far, kAdvice));
    }
    return lines;
}

std::optional<std::string> stageWarning(const Wall& wall) {
    const std::array<glm::dvec3, 4> corners = stageCorners(wall.stage);
    if (std::ranges::all_of(corners, [&](glm::dvec3 corner) { return tilesShowing(wall, corner).empty(); })) {
        return fmt::format("no tile shows a corner of the sand; {}, or move centre of [stage]", kAdvice);
    }
    return std::nullopt;
}

}  // namespace walls
