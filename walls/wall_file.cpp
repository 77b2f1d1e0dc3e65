// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/input_error.hpp"
#include "files/toml_table.hpp"
#include "walls/projection.hpp"
#include "walls/wall.hpp"

namespace walls {
namespace {

using files::TomlTable;

// Units mixed up (millimetres, pixels) are the usual mistake: no display or room is larger than this.
constexpr double kMaxLength = 1000;        // [m]
constexpr double kMaxEyeSeparation = 0.5;  // [m]
constexpr double kMinEyeDistance = 0.01;   // [m], nearer than this a frustum has no sensible shape
// A tape measure is good for 1 mm in 1 m; beyond two of them a corner is a mistake.
constexpr double kSquareTolerance = 2e-3;  // cosine of the angle at a corner
constexpr double kAspectTolerance = 0.01;

std::string text(glm::dvec3 point) { return fmt::format("({:.3f}, {:.3f}, {:.3f})", point.x, point.y, point.z); }

glm::dvec3 point(const TomlTable& table, std::string_view key) {
    const std::vector<double> n = table.numbers(key, 3);
    const glm::dvec3 result(n[0], n[1], n[2]);
    if (std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}) > kMaxLength) {
        table.fail(key, fmt::format("{} is in metres and must lie within {} of the origin, got {}", key, kMaxLength,
                                    text(result)));
    }
    return result;
}

glm::dvec3 direction(const TomlTable& table, std::string_view key, glm::dvec3 fallback) {
    const std::vector<double> n = table.numbersOr(key, {fallback.x, fallback.y, fallback.z});
    const glm::dvec3 result(n[0], n[1], n[2]);
    const double length = glm::length(result);
    if (!(length > 1e-6 && length < 1e6)) {
        table.fail(key, fmt::format("{} must be a direction such as [1, 0, 0], got {}", key, text(result)));
    }
    return result / length;
}

double length(const TomlTable& table, std::string_view key, double value, double lowest) {
    if (!(value >= lowest && value <= kMaxLength)) {
        table.fail(key, value < lowest && lowest > 0
                            ? fmt::format("{} must be positive, got {}", key, value)
                            : fmt::format("{} is in metres and must be within [{}, {}], got {}", key, lowest,
                                          kMaxLength, value));
    }
    return value;
}

glm::ivec2 pixels(const TomlTable& table, std::string_view key) {
    const std::vector<double> n = table.numbers(key, 2);
    for (const double side : n) {
        if (side < 1 || side > kMaxTileSide || side != std::floor(side)) {
            table.fail(key,
                       fmt::format("{} must be two whole numbers within [1, {}], got {}", key, kMaxTileSide, side));
        }
    }
    return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

/// `up` made exactly perpendicular to the unit vector `right`; complains when it was not nearly so.
glm::dvec3 squared(const TomlTable& table, std::string_view key, glm::dvec3 right, glm::dvec3 up,
                   const std::string& what) {
    const double size = glm::length(up);
    const double cosine = glm::dot(right, up) / size;
    if (!(std::abs(cosine) <= kSquareTolerance)) {
        table.fail(key, fmt::format("{} must be at right angles, got {:.2f} degrees", what,
                                    glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)))));
    }
    return glm::normalize(up - right * glm::dot(right, up)) * size;
}

Viewer readViewer(const TomlTable& table) {
    Viewer viewer;
    viewer.eye = point(table, "eye");
    viewer.eyeSeparation = table.numberOr("eye_separation", viewer.eyeSeparation, files::kPositive);
    if (viewer.eyeSeparation > kMaxEyeSeparation) {
        table.fail("eye_separation", fmt::format("eye_separation is in metres and must be at most {}, got {}",
                                                 kMaxEyeSeparation, viewer.eyeSeparation));
    }
    viewer.right = direction(table, "right", viewer.right);
    table.finish();
    return viewer;
}

Stereo readStereo(const TomlTable& file) {
    const std::optional<TomlTable> table = file.table("stereo");
    if (!table) {
        return Stereo::mono;
    }
    const int mode =
        table->choiceOr("mode", {stereoNames().begin(), stereoNames().end()}, static_cast<int>(Stereo::mono));
    table->finish();
    return static_cast<Stereo>(mode);
}

Clip readClip(const TomlTable& file) {
    Clip clip;
    if (const std::optional<TomlTable> table = file.table("clip")) {
        clip.near = table->numberOr("near", clip.near, files::kPositive);
        clip.far = table->numberOr("far", clip.far, files::kPositive);
        if (!(clip.far > clip.near)) {
            table->fail("far", fmt::format("far must lie beyond near ({} m), got {}", clip.near, clip.far));
        }
        table->finish();
    }
    return clip;
}

Stage readStage(const TomlTable& table) {
    Stage stage;
    stage.centre = point(table, "centre");
    stage.width = length(table, "width", table.number("width", files::kPositive), 1e-3);
    stage.tiltDegrees = table.numberOr("tilt_deg", 0, {-90, 90});
    stage.turnDegrees = table.numberOr("turn_deg", 0, {-180, 180});
    table.finish();
    return stage;
}

glm::dvec2 lengths(const TomlTable& table, std::string_view key, double lowest) {
    const std::vector<double> n = table.numbers(key, 2);
    return {length(table, key, n[0], lowest), length(table, key, n[1], lowest)};
}

Grid readGrid(const TomlTable& table) {
    Grid grid;
    grid.rows = table.integer("rows", 1, kMaxTiles);
    grid.columns = table.integer("columns", 1, kMaxTiles);
    if (grid.rows * grid.columns > kMaxTiles) {
        table.fail("columns", fmt::format("{} rows of {} columns are {} tiles; a wall has at most {}", grid.rows,
                                          grid.columns, grid.rows * grid.columns, kMaxTiles));
    }
    grid.tileSize = lengths(table, "tile_size", 1e-3);
    if (table.has("bezel")) {
        grid.bezel = lengths(table, "bezel", 0);
        if (glm::any(glm::greaterThan(grid.bezel, grid.tileSize))) {
            table.fail("bezel", fmt::format("bezel is in metres and must not exceed the tile, got [{}, {}]",
                                            grid.bezel.x, grid.bezel.y));
        }
    }
    grid.tilePixels = pixels(table, "tile_pixels");
    grid.lowerLeft = point(table, "lower_left");
    grid.right = direction(table, "right", grid.right);
    const glm::dvec3 up = direction(table, "up", grid.up);
    grid.up = squared(table, table.has("up") ? "up" : "right", grid.right, up, "right and up of the grid");
    table.finish();
    return grid;
}

/// Names become parts of file names.
std::string tileName(const TomlTable& table, const std::vector<Tile>& others) {
    std::string name = table.text("name");
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
    if (name.empty() || name.size() > 32 || !plain) {
        table.fail("name", "name of a screen must be 1 to 32 letters, digits, '_' or '-'");
    }
    if (std::any_of(others.begin(), others.end(), [&](const Tile& tile) { return tile.name == name; })) {
        table.fail("name", fmt::format("two tiles are called '{}'; give each its own name", name));
    }
    return name;
}

Screen readCorners(const TomlTable& table) {
    Screen screen;
    screen.lowerLeft = point(table, "lower_left");
    screen.lowerRight = point(table, "lower_right");
    screen.upperLeft = point(table, "upper_left");
    for (const auto& [key, side] :
         {std::pair{"lower_right", screen.width()}, std::pair{"upper_left", screen.height()}}) {
        if (!(side >= 1e-3)) {
            table.fail(key, fmt::format("{} must lie away from lower_left: the screen has no size", key));
        }
    }
    const glm::dvec3 up =
        squared(table, "upper_left", screen.right(), screen.upperLeft - screen.lowerLeft, "the edges at lower_left");
    screen.upperLeft = screen.lowerLeft + up;
    return screen;
}

Tile readScreen(const TomlTable& table, const Wall& wall) {
    Tile tile;
    tile.rank = wall.ranks() + 1;
    tile.name = tileName(table, wall.tiles);
    tile.screen = readCorners(table);
    tile.pixels = pixels(table, "pixels");
    tile.outputs = outputsOf(wall.stereo, tile.name);
    table.finish();
    return tile;
}

void checkPixelShape(const TomlTable& table, std::string_view key, const Tile& tile) {
    const double across = tile.screen.width() / tile.pixels.x;
    const double down = tile.screen.height() / tile.pixels.y;
    if (std::abs(across / down - 1) > kAspectTolerance) {
        table.fail(key, fmt::format("pixels of tile '{}' would be {:.4g} x {:.4g} mm; they must be square within 1 %: "
                                    "check metres against pixels",
                                    tile.name, across * 1000, down * 1000));
    }
}

void checkEyes(const TomlTable& table, const Wall& wall, const Tile& tile) {
    for (const Eye eye : eyesOf(wall.stereo)) {
        const glm::dvec3 position = eyePosition(wall.viewer, eye);
        if (!(tile.screen.distanceTo(position) >= kMinEyeDistance)) {
            table.fail("lower_left",
                       fmt::format("the {} eye at {} is not in front of tile '{}': move [viewer] eye, or give the "
                                   "corners as the viewer sees them",
                                   eyeName(eye), text(position), tile.name));
        }
    }
}

std::string wallName(const TomlTable& file, const std::string& fallback) {
    std::string name = file.textOr("name", fallback);
    if (name.empty() || name.size() > 100 ||
        std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; })) {
        file.fail("name", "name must be one line of at most 100 characters");
    }
    return name;
}

Wall readWall(const TomlTable& file, const std::string& fallbackName) {
    Wall wall;
    wall.name = wallName(file, fallbackName);
    wall.viewer = readViewer(file.requiredTable("viewer"));
    wall.stereo = readStereo(file);
    wall.clip = readClip(file);
    wall.stage = readStage(file.requiredTable("stage"));
    if (const std::optional<TomlTable> table = file.table("grid")) {
        wall.grid = readGrid(*table);
        wall.tiles = tilesOf(*wall.grid, wall.stereo);
        for (const Tile& tile : wall.tiles) {
            checkPixelShape(*table, "tile_pixels", tile);
            checkEyes(*table, wall, tile);
        }
    }
    for (const TomlTable& table : file.tables("screen")) {
        if (wall.ranks() == kMaxTiles) {
            table.fail("name", fmt::format("one screen too many: a wall has at most {} tiles", kMaxTiles));
        }
        const Tile tile = readScreen(table, wall);
        checkPixelShape(table, "pixels", tile);
        checkEyes(table, wall, tile);
        wall.tiles.push_back(tile);
    }
    file.finish();
    if (wall.tiles.empty()) {
        file.fail("", "the wall has no tile: write [grid], or [[screen]] for each screen");
    }
    return wall;
}

std::string fallbackName(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    return stem.empty() ? "wall" : stem.substr(0, 100);
}

}  // namespace

Wall loadWall(const std::filesystem::path& file) { return readWall(TomlTable::load(file), fallbackName(file)); }

Wall parseWall(std::string_view text, const std::string& name) {
    return readWall(TomlTable::parse(text, name), fallbackName(name));
}

}  // namespace walls
