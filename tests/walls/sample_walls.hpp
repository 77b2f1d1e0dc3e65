// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "shapes/box_outline.hpp"
#include "walls/canvas.hpp"
#include "walls/projection.hpp"
#include "walls/wall.hpp"

namespace walls {

inline std::filesystem::path configFolder() { return std::filesystem::path(SANDWALL_SOURCE_DIR) / "walls/configs"; }
inline Wall config(const std::string& name) { return loadWall(configFolder() / name); }

/// Returns the names of all sample walls. Throws if there is no sample.
inline std::vector<std::string> configNames() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(configFolder())) {
        if (entry.path().extension() == ".toml") {
            names.push_back(entry.path().filename().string());
        }
    }
    if (names.empty()) {
        throw std::runtime_error("no wall file in " + configFolder().string() +
                                 ": a test of all of them would test nothing");
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// Returns the error for the text of a wall, or "no complaint".
inline std::string complaint(const std::string& text) {
    try {
        (void)parseWall(text, "lab.toml");
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "no complaint";
}

/// Returns a 0.8 x 0.6 m screen of 800 x 600 pixels, straight in front of an eye 2 m away at the height of its middle.
inline Screen plainScreen() { return {{-0.4, 0, 0}, {0.4, 0, 0}, {-0.4, 0.6, 0}}; }

/// Returns the place at which the matrices show a point of the room, on the plane of the screen [m, room].
inline glm::dvec3 shownAt(const Screen& screen, const View& view, glm::dvec3 point) {
    const glm::dvec4 clip = view.viewProjection * glm::dvec4(point, 1);
    return screen.lowerLeft + (screen.lowerRight - screen.lowerLeft) * ((clip.x / clip.w + 1) / 2) +
           (screen.upperLeft - screen.lowerLeft) * ((clip.y / clip.w + 1) / 2);
}

/// Returns the rectangle around all screens of a wall, in the plane of the first. Returns nullopt if the screens are
/// not in one plane, as in a CAVE: no single camera sees them.
inline std::optional<Screen> wholeOfFlat(const Wall& wall) {
    const Screen& first = wall.tiles[0].screen;
    glm::dvec2 lowest(0), highest(0);
    for (const Tile& tile : wall.tiles) {
        for (const glm::dvec3 corner :
             {tile.screen.lowerLeft, tile.screen.lowerRight, tile.screen.upperLeft, tile.screen.upperRight()}) {
            if (std::abs(first.distanceTo(corner)) > 1e-9) {
                return std::nullopt;
            }
            const glm::dvec3 from = corner - first.lowerLeft;
            const glm::dvec2 place(glm::dot(from, first.right()), glm::dot(from, first.up()));
            lowest = glm::min(lowest, place);
            highest = glm::max(highest, place);
        }
    }
    const auto at = [&](double x, double y) { return first.lowerLeft + first.right() * x + first.up() * y; };
    return Screen{at(lowest.x, lowest.y), at(highest.x, lowest.y), at(lowest.x, highest.y)};
}

/// Expects that the tiles of a flat wall together show all eight corners of a box to each of their eyes.
inline void expectShown(const Wall& wall, const glm::dmat4& sceneToRoom, const shapes::Box& box) {
    const std::optional<Screen> whole = wholeOfFlat(wall);
    ASSERT_TRUE(whole);
    for (const Eye eye : eyesOf(wall.stereo)) {
        const View view = viewOf(*whole, eyePosition(wall.viewer, eye), wall.clip.near, wall.clip.far);
        for (const glm::dvec3& corner : shapes::cornersOf(box)) {
            const glm::dvec4 clip = view.viewProjection * sceneToRoom * glm::dvec4(corner, 1);
            for (const double along : {clip.x, clip.y, clip.z}) {
                EXPECT_LE(std::abs(along), clip.w * (1 + 1e-6))
                    << "corner " << corner.x << ", " << corner.y << ", " << corner.z;
            }
        }
    }
}

/// Returns the place at which the matrices show a point, in pixels of a canvas. It may lie outside the tile.
inline glm::dvec2 pixelAt(const PixelRect& rect, const View& view, glm::dvec3 point) {
    const glm::dvec4 clip = view.viewProjection * glm::dvec4(point, 1);
    return {rect.x + rect.width * (clip.x / clip.w + 1) / 2, rect.y + rect.height * (1 - clip.y / clip.w) / 2};
}

}  // namespace walls
