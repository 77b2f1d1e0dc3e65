// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/input_error.hpp"
#include "walls/wall_check.hpp"

namespace walls {
namespace {

using namespace wall_file;

Viewer readViewer(const TomlTable& table) {
    table.only({"eye", "eye_separation", "right"});
    Viewer viewer;
    viewer.eye = point(table, "eye");
    viewer.eyeSeparation = table.numberOr("eye_separation", viewer.eyeSeparation, host::kPositive);
    if (viewer.eyeSeparation > kMaxEyeSeparation) {
        table.fail("eye_separation", fmt::format("eye_separation is in metres and must be at most {}, got {}",
                                                 kMaxEyeSeparation, viewer.eyeSeparation));
    }
    viewer.right = direction(table, "right", viewer.right);
    return viewer;
}

/// Reads [stereo]. Returns the mode, and whether the eyes are swapped.
std::pair<Stereo, bool> readStereo(const TomlTable& file) {
    const std::optional<TomlTable> table = file.table("stereo");
    if (!table) {
        return {Stereo::mono, false};
    }
    table->only({"mode", "swap_eyes"});
    const Stereo stereo = table->valueOr("mode", Stereo::mono);
    const bool swapEyes = table->flagOr("swap_eyes", false);
    if (swapEyes && eyesOf(stereo).size() < 2) {
        table->fail("swap_eyes", fmt::format("swap_eyes needs a mode with two eyes, and {} draws one: choose another "
                                             "mode, or leave swap_eyes out",
                                             stereoName(stereo)));
    }
    return {stereo, swapEyes};
}

std::string readTracking(const TomlTable& file) {
    const std::optional<TomlTable> table = file.table("tracking");
    if (!table) {
        return {};
    }
    table->only({"source"});
    std::string source = table->text("source");
    if (source.empty() || !isOneLine(source, kMaxTracking)) {
        table->fail("source", fmt::format("source must be one line of 1 to {} characters, such as \"opentrack:4242\"",
                                          kMaxTracking));
    }
    return source;
}

Clip readClip(const TomlTable& file) {
    Clip clip;
    if (const std::optional<TomlTable> table = file.table("clip")) {
        table->only({"near", "far"});
        clip.near = table->numberOr("near", clip.near, host::kPositive);
        clip.far = table->numberOr("far", clip.far, host::kPositive);
        if (!(clip.far > clip.near)) {
            table->fail(table->has("far") ? "far" : "near",
                        fmt::format("far must lie beyond near ({} m), got {}", clip.near, clip.far));
        }
    }
    return clip;
}

Stage readStage(const TomlTable& table) {
    table.only({"centre", "width", "tilt_deg", "turn_deg"});
    Stage stage;
    stage.centre = point(table, "centre");
    stage.width = length(table, "width", table.number("width", host::kPositive), 1e-3);
    stage.tiltDegrees = table.numberOr("tilt_deg", 0, {-90, 90});
    stage.turnDegrees = table.numberOr("turn_deg", 0, {-180, 180});
    return stage;
}

std::string readName(const TomlTable& file, const std::string& fallback) {
    std::string name = file.textOr("name", fallback);
    if (name.empty() || !isOneLine(name, 100)) {
        file.fail("name", "name must be one line of at most 100 characters");
    }
    return name;
}

void checkTile(const TomlTable& table, std::string_view pixelKey, const Wall& wall, const Tile& tile) {
    if (const auto fault = pixelFault(wall.stereo, tile)) {
        table.fail(pixelKey, *fault);
    }
    if (const auto fault = eyeFault(wall, tile)) {
        table.fail("lower_left", *fault);
    }
}

void readTiles(const TomlTable& file, Wall& wall) {
    if (const std::optional<TomlTable> table = file.table("grid")) {
        wall.grid = readGrid(*table);
        wall.tiles = tilesOf(*wall.grid, wall.stereo);
        for (const Tile& tile : wall.tiles) {
            checkTile(*table, "tile_pixels", wall, tile);
        }
    }
    for (const TomlTable& table : file.tables("screen")) {
        wall.tiles.push_back(readScreen(table, wall.stereo, wall.tiles));
        checkTile(table, "pixels", wall, wall.tiles.back());
    }
    if (wall.tiles.empty()) {
        file.fail("", "the wall has no tile: write [grid], or [[screen]] for each screen");
    }
}

Wall readWall(const TomlTable& file, const std::string& fallbackName) {
    file.only({"name", "refresh", "viewer", "stereo", "tracking", "clip", "stage", "grid", "screen", "place"});
    Wall wall;
    wall.name = readName(file, fallbackName);
    wall.refreshHz = file.numberOr("refresh", wall.refreshHz, {kMinRefresh, kMaxRefresh});
    const TomlTable viewer = file.requiredTable("viewer");
    wall.viewer = readViewer(viewer);
    const auto [stereo, swapEyes] = readStereo(file);
    wall.stereo = stereo;
    wall.tracking = readTracking(file);
    wall.clip = readClip(file);
    wall.stage = readStage(file.requiredTable("stage"));
    readTiles(file, wall);
    if (const auto fault = viewerFault(wall)) {
        viewer.fail("right", *fault);
    }
    readPlaces(file, wall.stereo, wall.tiles);
    return withSwappedEyes(std::move(wall), swapEyes);
}

std::string fallbackName(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    return stem.empty() ? "wall" : stem.substr(0, 100);
}

}  // namespace

Wall loadWall(const std::filesystem::path& file) { return readWall(TomlTable::load(file), fallbackName(file)); }

Wall loadWallAs(const std::filesystem::path& file, const std::string& stereo) {
    Wall wall = loadWall(file);
    if (stereo.empty()) {
        return wall;
    }
    Wall other = shownIn(wall, stereoNamed(stereo));
    if (const auto fault = viewFault(other)) {
        throw base::InputError(fmt::format("{}: shown in {}: {}", file.string(), stereo, *fault));
    }
    return other;
}

Wall parseWall(std::string_view text, const std::string& name) {
    return readWall(TomlTable::parse(text, name), fallbackName(name));
}

}  // namespace walls
