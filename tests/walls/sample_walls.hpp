// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/input_error.hpp"
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

/// Returns the place at which the matrices show a point, in pixels of a canvas. It may lie outside the tile.
inline glm::dvec2 pixelAt(const PixelRect& rect, const View& view, glm::dvec3 point) {
    const glm::dvec4 clip = view.viewProjection * glm::dvec4(point, 1);
    return {rect.x + rect.width * (clip.x / clip.w + 1) / 2, rect.y + rect.height * (1 - clip.y / clip.w) / 2};
}

}  // namespace walls
