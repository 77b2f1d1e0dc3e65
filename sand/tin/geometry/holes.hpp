// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// Samples of a raster in a TIN's field, each in the middle of a cell; what of a cell lies beyond the field is not.
struct Cells {
    int columns = 0, rows = 0;
    Place first{};                                    // of the sample in the south-west [probe unit]
    Place spacing{kLatticePerCell, kLatticePerCell};  // of columns and of rows [probe unit]
    std::int32_t width = 0, depth = 0;                // of the field [probe unit]
    friend bool operator==(const Cells&, const Cells&) = default;

    /// Where the cells of a column begin; of `columns`, where the last ends.
    [[nodiscard]] std::int32_t west(int column) const;
    [[nodiscard]] std::int32_t south(int row) const;
    /// Of the cell that holds x / scale; those on a border are the one beyond. May lie outside.
    [[nodiscard]] int columnOf(std::int64_t x, int scale = 1) const;
    [[nodiscard]] int rowOf(std::int64_t y, int scale = 1) const;
};

/// Cells without data: where a TIN has no ground, and sand neither enters nor leaves.
///
/// Where two such cells touch at nothing but a corner, a square of an eighth of a cell to each side of it has no ground
/// either: a vertex there would belong to the ground on both sides, and sand passes through no corner on a grid. All
/// borders run along the axes, so that a constraint on one stays on it though others cross it. Never changes; memory
/// follows rows, runs and outline, and only terrain with holes has one. Read by any thread.
class Holes {
public:
    /// Cells of a row, from `first` to before `end`.
    struct Run {
        std::int32_t row = 0, first = 0, end = 0;
        friend bool operator==(const Run&, const Run&) = default;
    };
    /// Throws std::invalid_argument unless there are runs, each of a cell or more, in order, apart, and of the field.
    Holes(const Cells& cells, std::vector<Run> runs);

    [[nodiscard]] const Cells& cells() const { return cells_; }
    [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
    /// Whether a cell has no ground; those outside the field have none.
    [[nodiscard]] bool isHole(int column, int row) const;
    /// Of a place on a border: whether that is in a hole is left to chance.
    [[nodiscard]] bool holds(const Place& place) const { return holds(place.x, place.y, 1); }
    /// Whether a triangle has no ground; none may lie in a hole and beside it.
    [[nodiscard]] bool holds(const Place& a, const Place& b, const Place& c) const;
    /// Whether the edge between two places runs along the border of a hole, no end of which lies between them.
    [[nodiscard]] bool borders(const Place& a, const Place& b) const;
    /// Whether any cell without ground reaches into a rectangle, its sides included.
    [[nodiscard]] bool reachInto(const Place& southWest, const Place& northEast) const;

    /// The border of all holes, without the field's rim, in straight parts as long as can be.
    struct Part {
        Place from, to;
    };
    [[nodiscard]] const std::vector<Part>& outline() const { return outline_; }

    /// Whether the corner south-west of a cell is one at which two cells without ground touch, and no more.
    [[nodiscard]] bool isPinch(int column, int row) const;
    /// Half the side of the square around such [probe unit].
    [[nodiscard]] std::int32_t bridge() const { return bridge_; }

private:
    [[nodiscard]] bool holds(std::int64_t x, std::int64_t y, int scale) const;

    Cells cells_;
    std::vector<Run> runs_;
    std::vector<std::uint32_t> firstRun_;  // by row, and behind the last
    std::int32_t bridge_;
    std::vector<Part> outline_;
};

}  // namespace sand::tin
