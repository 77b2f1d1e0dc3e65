// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "walls/wall_file.hpp"

namespace walls::wall_file {
namespace {

/// Returns the gap between lit areas [m]. It is negative if they overlap.
glm::dvec2 readGap(const TomlTable& table, glm::dvec2 tileSize) {
    if (table.has("bezel") && table.has("overlap")) {
        table.fail("overlap", "a grid has bezels or an overlap, not both: leave one out");
    }
    if (table.has("bezel")) {
        const glm::dvec2 bezel = lengths(table, "bezel", 0);
        if (glm::any(glm::greaterThan(bezel, tileSize))) {
            table.fail("bezel",
                       fmt::format("bezel is in metres and must not exceed the tile, got [{}, {}]", bezel.x, bezel.y));
        }
        return bezel;
    }
    if (!table.has("overlap")) {
        return {0, 0};
    }
    const glm::dvec2 overlap = lengths(table, "overlap", 0);
    // Neighbouring tiles must be offset by at least 1 mm, the least length in a wall file.
    if (glm::any(glm::greaterThan(overlap + 1e-3, tileSize))) {
        table.fail("overlap", fmt::format("overlap is in metres and must be less than the tile, got [{}, {}]",
                                          overlap.x, overlap.y));
    }
    return glm::dvec2(0) - overlap;  // -overlap could print a negative zero
}

}  // namespace

Grid readGrid(const TomlTable& table) {
    table.only({"rows", "columns", "tile_size", "bezel", "overlap", "tile_pixels", "lower_left", "right", "up"});
    Grid grid;
    grid.rows = table.integer("rows", 1, kMaxTiles);
    grid.columns = table.integer("columns", 1, kMaxTiles);
    if (grid.rows * grid.columns > kMaxTiles) {
        table.fail("columns", fmt::format("{} rows of {} columns are {} tiles; a wall has at most {}", grid.rows,
                                          grid.columns, grid.rows * grid.columns, kMaxTiles));
    }
    grid.tileSize = lengths(table, "tile_size", 1e-3);
    grid.bezel = readGap(table, grid.tileSize);
    grid.tilePixels = pixels(table, "tile_pixels");
    grid.lowerLeft = point(table, "lower_left");
    grid.right = direction(table, "right", grid.right);
    const glm::dvec3 up = direction(table, "up", grid.up);
    grid.up = squared(table, table.has("up") ? "up" : "right", grid.right, up, "right and up of the grid");
    return grid;
}

}  // namespace walls::wall_file
