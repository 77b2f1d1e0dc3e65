// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "walls/canvas.hpp"
#include "walls/wall.hpp"

/// Walls for tests that start a session: walls of the project's files at a smaller size, or seen by one camera.
namespace support {

inline std::string tomlList(glm::dvec2 v) { return fmt::format("[{:.17g}, {:.17g}]", v.x, v.y); }
inline std::string tomlList(glm::ivec2 v) { return fmt::format("[{}, {}]", v.x, v.y); }
inline std::string tomlList(glm::dvec3 v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

inline std::string placeText(const walls::Tile& tile) {
    std::string text;
    const auto add = [&](const char* key, const std::string& value) { text += fmt::format("{} = {}\n", key, value); };
    if (!tile.place.host.empty()) {
        add("host", '"' + tile.place.host + '"');
    }
    if (!tile.place.display.empty()) {
        add("display", '"' + tile.place.display + '"');
    }
    if (tile.place.device >= 0) {
        add("device", std::to_string(tile.place.device));
    }
    std::string monitors, windows;
    for (const walls::Output& output : tile.outputs) {
        monitors += output.monitor.empty() ? "" : fmt::format("\"{}\", ", output.monitor);
        windows += output.window ? tomlList(*output.window) + ", " : "";
    }
    if (!monitors.empty()) {
        add("monitors", "[" + monitors + "]");
    }
    if (!windows.empty()) {
        add("windows", "[" + windows + "]");
    }
    return text.empty() ? text : fmt::format("[[place]]\ntiles = [\"{}\"]\n{}", tile.name, text);
}

/// Returns the text of a wall file that describes this wall. No explicit screen may overlap another tile.
inline std::string wallText(const walls::Wall& wall) {
    std::string text = fmt::format("name = \"{}\"\nrefresh = {:.17g}\n", wall.name, wall.refreshHz);
    text += fmt::format("[viewer]\neye = {}\neye_separation = {:.17g}\nright = {}\n[stereo]\nmode = \"{}\"\n",
                        tomlList(wall.viewer.eye), wall.viewer.eyeSeparation, tomlList(wall.viewer.right),
                        walls::stereoName(wall.stereo));
    if (!wall.tracking.empty()) {
        text += fmt::format("[tracking]\nsource = \"{}\"\n", wall.tracking);
    }
    text += fmt::format("[clip]\nnear = {:.17g}\nfar = {:.17g}\n", wall.clip.near, wall.clip.far);
    text += fmt::format("[stage]\ncentre = {}\nwidth = {:.17g}\ntilt_deg = {:.17g}\nturn_deg = {:.17g}\n",
                        tomlList(wall.stage.centre), wall.stage.width, wall.stage.tiltDegrees, wall.stage.turnDegrees);
    if (wall.grid) {
        const walls::Grid& grid = *wall.grid;
        const bool overlap = std::min(grid.bezel.x, grid.bezel.y) < 0;
        text += fmt::format("[grid]\nrows = {}\ncolumns = {}\ntile_size = {}\n{} = {}\ntile_pixels = {}\n", grid.rows,
                            grid.columns, tomlList(grid.tileSize), overlap ? "overlap" : "bezel",
                            tomlList(overlap ? glm::dvec2(0) - grid.bezel : grid.bezel), tomlList(grid.tilePixels));
        text += fmt::format("lower_left = {}\nright = {}\nup = {}\n", tomlList(grid.lowerLeft), tomlList(grid.right),
                            tomlList(grid.up));
    }
    for (const walls::Tile& tile : wall.tiles) {
        if (tile.row == 0) {
            text += fmt::format(
                "[[screen]]\nname = \"{}\"\nlower_left = {}\nlower_right = {}\nupper_left = {}\npixels = {}\n",
                tile.name, tomlList(tile.screen.lowerLeft), tomlList(tile.screen.lowerRight),
                tomlList(tile.screen.upperLeft), tomlList(tile.pixels));
        }
    }
    for (const walls::Tile& tile : wall.tiles) {
        text += placeText(tile);
    }
    return text;
}

/// Returns the wall with `factor` times its pixels and the same size in metres. Rounds bezels to whole pixels, so that
/// the picture of one camera can be cut into tiles. A bezel that is not 0 has at least one pixel. Windows move
/// together.
inline walls::Wall reduced(walls::Wall wall, double factor) {
    const auto fewer = [&](glm::ivec2 pixels) {
        return glm::max(glm::ivec2(glm::round(glm::dvec2(pixels) * factor)), glm::ivec2(1));
    };
    const walls::Wall was = wall;
    if (wall.grid) {
        walls::Grid& grid = *wall.grid;
        grid.tilePixels = fewer(grid.tilePixels);
        for (int axis = 0; axis < 2; ++axis) {
            const double pixel = grid.tileSize[axis] / grid.tilePixels[axis];
            const double whole = std::max(1.0, std::round(std::abs(grid.bezel[axis]) / pixel));
            grid.bezel[axis] = grid.bezel[axis] == 0 ? 0 : std::copysign(whole * pixel, grid.bezel[axis]);
        }
        std::vector<walls::Tile> tiles = walls::tilesOf(grid, wall.stereo);
        std::copy(tiles.begin(), tiles.end(), wall.tiles.begin());
    }
    for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
        walls::Tile& tile = wall.tiles[i];
        tile.pixels = fewer(was.tiles[i].pixels);
        tile.place = was.tiles[i].place;
        tile.outputs = was.tiles[i].outputs;
        for (walls::Output& output : tile.outputs) {
            if (output.window) {
                output.window = glm::ivec2(glm::round(glm::dvec2(*output.window) * factor));
            }
        }
    }
    return wall;
}

/// Returns the text of one of the project's wall files, reduced.
inline std::string reducedWall(const std::filesystem::path& config, double factor) {
    return wallText(reduced(walls::loadWall(config), factor));
}

/// Returns a wall with one camera over the whole grid, including its bezels. Its only tile is "r1c1". The tiles of the
/// grid are at wallCanvas(wall).tiles in its picture. Leaves out explicit screens. Throws std::invalid_argument as
/// walls::wholeWall does.
inline walls::Wall wholeWallOf(walls::Wall wall) {
    std::erase_if(wall.tiles, [](const walls::Tile& tile) { return tile.row == 0; });
    return walls::wholeWall(wall);
}

/// Returns a wall with one camera that sees the single tile `name`, as an explicit screen of the same name, place and
/// corners.
inline walls::Wall wholeWallOf(walls::Wall wall, const std::string& name) {
    std::erase_if(wall.tiles, [&](const walls::Tile& tile) { return tile.name != name; });
    if (wall.tiles.empty()) {
        throw std::invalid_argument("the wall has no tile " + name);
    }
    wall.grid.reset();
    wall.tiles.front().rank = 1;
    wall.tiles.front().row = wall.tiles.front().column = 0;
    return wall;
}

}  // namespace support
