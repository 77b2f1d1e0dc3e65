// SPDX-License-Identifier: Apache-2.0
#include "walls/draft/new_wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/vec2.hpp>
#include <numbers>

#include "base/input_error.hpp"
#include "host/whole_file.hpp"
#include "shapes/box_outline.hpp"

namespace walls {
namespace {

constexpr int kMostInARow = 32;          // a wall has at most 1024 tiles
constexpr glm::dvec2 kTile{1.21, 0.68};  // [m], of a display of 55 inches
constexpr double kBezel = 0.004;         // [m]
constexpr double kMiddle = 1.5;          // [m], height of the wall's middle, if its lower edge is above the floor
constexpr double kFoot = 0.1;            // [m], lowest lower edge
constexpr double kBefore = 0.25;         // [m], from the wall to the sand's south edge
constexpr double kMargin = 0.03;         // [share of the wall] around the box of the sand, at least

/// Numbers of rows and columns of displays.
struct DisplayGrid {
    int rows = 0, columns = 0;
};

DisplayGrid parseGrid(const std::string& text) {
    DisplayGrid grid;
    const char* const end = text.data() + text.size();
    const auto [cross, first] = std::from_chars(text.data(), end, grid.rows);
    if (first == std::errc() && cross != end && *cross == 'x') {
        const auto [rest, second] = std::from_chars(cross + 1, end, grid.columns);
        if (second == std::errc() && rest == end && std::clamp(grid.rows, 1, kMostInARow) == grid.rows &&
            std::clamp(grid.columns, 1, kMostInARow) == grid.columns) {
            return grid;
        }
    }
    throw base::InputError(
        fmt::format("--new: '{}' must be ROWSxCOLUMNS, such as 2x3, each from 1 to {}", text, kMostInARow));
}

double lengthOf(int tiles, double tile) { return tiles * tile + (tiles - 1) * kBezel; }

/// A wall from its lower edge at `foot` upwards, and an eye before its middle [m].
struct Front {
    double width, height, foot, eyeHeight, distance;

    /// Returns the height at which the wall shows a point at the height `y`, `z` before the wall.
    [[nodiscard]] double shown(double y, double z) const {
        return eyeHeight + (y - eyeHeight) * distance / (distance - z);
    }
};

/// Square table of sand, tilted by 45 degrees, whose south edge is kBefore the wall.
struct Table {
    double side, south;  // [m]; height of the south edge

    [[nodiscard]] double half() const { return side / 2 / std::numbers::sqrt2; }  // up, and back
    /// Returns whether the wall shows the whole box around level sand, with its boards.
    [[nodiscard]] bool fits(const Front& wall) const {
        const shapes::Box box = shapes::boxOutline(glm::dvec2(side), 0, 0);
        return std::ranges::all_of(shapes::cornersOf(box), [&](glm::dvec3 corner) {
            const double up = (corner.y + corner.z) / std::numbers::sqrt2;
            const double forward = (corner.z - corner.y) / std::numbers::sqrt2;
            const double z = kBefore + forward;
            const double across = std::abs(corner.x - side / 2) * wall.distance / (wall.distance - z);
            const double share = (wall.shown(south + up, z) - wall.foot) / wall.height;
            return across <= (0.5 - kMargin) * wall.width && share >= kMargin && share <= 1 - kMargin;
        });
    }
};

/// Returns the largest table that the wall shows whole.
Table tableOn(const Front& wall) {
    Table table{wall.width, wall.foot};
    while (!table.fits(wall)) {
        table.south += 0.01 * wall.height;
        if (table.south > wall.foot + wall.height) {
            table = {table.side * 0.98, wall.foot};
        }
    }
    return table;
}

std::string textOf(const DisplayGrid& grid, const std::string& name) {
    const double width = lengthOf(grid.columns, kTile.x), height = lengthOf(grid.rows, kTile.y);
    const double foot = std::max(kFoot, kMiddle - height / 2);
    const Front wall{width, height, foot, std::max(1.6, foot + height / 2), std::max(2.0, width)};
    const Table table = tableOn(wall);
    return fmt::format(
        R"(# {0} rows of {1} displays. Change the values to those of your wall, and check them:
#     scripts/sandwall check FILE
# docs/wall_files.md explains every key.
name = "{2}"

[viewer]
eye = [0.0, {3:.2f}, {4:.2f}]    # m, midpoint of the eyes: right, up and back from the wall's middle at the floor

[stereo]
mode = "mono"              # "passive" with two projectors for each tile

[grid]
rows = {0}
columns = {1}
tile_size = [{5}, {6}]   # m, lit area of one display; measure it
bezel = [{7}, {7}]     # m, gap between the lit areas of neighbours
tile_pixels = [1920, 1080]
lower_left = [{8:.3f}, {9:.3f}, 0.0]    # m, lower left corner of the whole wall

# A table of sand, tilted towards the viewer.
[stage]
centre = [0.0, {10:.3f}, {11:.3f}]   # m
width = {12:.2f}
tilt_deg = 45
)",
        grid.rows, grid.columns, name, wall.eyeHeight, wall.distance, kTile.x, kTile.y, kBezel, -width / 2, foot,
        table.south + table.half(), kBefore - table.half(), table.side);
}

/// Returns a name for the wall that needs no escapes in TOML.
std::string nameOf(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    const bool plain =
        std::ranges::all_of(stem, [](unsigned char c) { return c >= ' ' && c < 127 && c != '"' && c != '\\'; });
    return plain && !stem.empty() ? stem : "wall";
}

}  // namespace

void writeNewWall(const std::filesystem::path& file, const std::string& grid) {
    const std::string text = textOf(parseGrid(grid), nameOf(file));
    if (std::error_code none; std::filesystem::exists(std::filesystem::symlink_status(file, none))) {
        throw base::InputError(fmt::format("{}: exists and stays; give --new another file", file.string()));
    }
    host::WholeFile whole(file);
    whole.stream() << text;
    whole.keep();
}

}  // namespace walls
