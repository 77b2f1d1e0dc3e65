// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// Raster in a TIN's field, with a sample in the middle of each cell. The part of a cell beyond the field is cut off.
struct Cells {
    int columns = 0, rows = 0;
    LatticePoint first{};                                    // south-west sample [probe unit]
    LatticePoint spacing{kLatticePerCell, kLatticePerCell};  // distance of columns and of rows [probe unit]
    std::int32_t width = 0, depth = 0;                       // size of the field [probe unit]
    friend bool operator==(const Cells&, const Cells&) = default;

    /// Returns the x where the cells of `column` begin [probe unit]. For `columns`, returns where the last column
    /// ends.
    [[nodiscard]] std::int32_t west(int column) const;
    /// Returns the y where the cells of `row` begin [probe unit]. For `rows`, returns where the last row ends.
    [[nodiscard]] std::int32_t south(int row) const;
    /// Returns the column of the cell at x / `scale` [probe unit]. A border between cells belongs to the cell east of
    /// it. The column may lie outside the raster.
    [[nodiscard]] int columnOf(std::int64_t x, int scale = 1) const;
    /// Returns the row of the cell at y / `scale` [probe unit]. A border between cells belongs to the cell north of
    /// it. The row may lie outside the raster.
    [[nodiscard]] int rowOf(std::int64_t y, int scale = 1) const;
};

/// Cells without data. A TIN has no ground there, and sand neither enters nor leaves.
///
/// Two such cells may touch only at a corner. Then the square of an eighth of a cell to each side of the corner has no
/// ground either. Without the square, a vertex at the corner would belong to the ground on both sides. On a grid, sand
/// passes through no corner.
///
/// All borders run along the axes. A constraint on a border therefore stays on it when other constraints cross it.
///
/// Never changes, so that any thread may read it. Its memory grows with the numbers of rows, runs and parts of the
/// outline. Only terrain with holes has a Holes.
class Holes {
public:
    /// Cells of one row, from column `first` to before column `end`.
    struct Run {
        std::int32_t row = 0, first = 0, end = 0;
        template <class Self, class Visit>
        static void fields(Self& it, Visit& visit) {
            visit("row", it.row);
            visit("first", it.first);
            visit("end", it.end);
        }
        friend bool operator==(const Run&, const Run&) = default;
    };
    /// Throws std::invalid_argument unless `runs` is a non-empty list in order of row and column. Each run must have a
    /// cell or more and lie in the field. Two runs of one row must have a cell between them.
    Holes(const Cells& cells, std::vector<Run> runs);

    [[nodiscard]] const Cells& cells() const { return cells_; }
    [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
    /// Returns whether a cell has no ground. Cells outside the field have no ground.
    [[nodiscard]] bool isHole(int column, int row) const;
    /// Returns whether a place lies in a hole. For a place on a border, the result is unspecified.
    [[nodiscard]] bool holds(const LatticePoint& place) const { return holds(place.x, place.y, 1); }
    /// Returns whether a triangle has no ground. The triangle must lie wholly inside or wholly outside the holes.
    [[nodiscard]] bool holds(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) const;
    /// Returns whether the edge between two places runs along the border of a hole. No end of the border may lie
    /// between the two places.
    [[nodiscard]] bool borders(const LatticePoint& a, const LatticePoint& b) const;
    /// Returns whether a cell without ground reaches into the rectangle, which includes its sides.
    [[nodiscard]] bool reachInto(const LatticePoint& southWest, const LatticePoint& northEast) const;

    /// Straight part of a hole's border.
    struct Part {
        LatticePoint from, to;
    };
    /// Returns the border of all holes except on the field's rim, in parts that are as long as possible.
    [[nodiscard]] const std::vector<Part>& outline() const { return outline_; }
    /// Calls visit(part) for each part of the outline that reaches into the rectangle [probe unit], in the order of
    /// outline(). Leaves out the borders of the squares at corners where two cells touch.
    template <class Visit>
    void forEachPart(std::int32_t west, std::int32_t south, std::int32_t east, std::int32_t north,
                     const Visit& visit) const {
        const auto among = [&](std::size_t begin, std::size_t end, std::int32_t LatticePoint::*level,
                               std::int32_t first, std::int32_t last) {
            const auto from = outline_.begin() + static_cast<std::ptrdiff_t>(begin);
            const auto to = outline_.begin() + static_cast<std::ptrdiff_t>(end);
            auto part = std::lower_bound(from, to, first,
                                         [level](const Part& one, std::int32_t at) { return one.from.*level < at; });
            for (; part != to && part->from.*level <= last; ++part) {
                if (part->from.x <= east && part->to.x >= west && part->from.y <= north && part->to.y >= south) {
                    visit(*part);
                }
            }
        };
        among(0, level_, &LatticePoint::y, south, north);
        among(level_, upright_, &LatticePoint::x, west, east);
    }

    /// Returns whether two cells without ground touch only at the south-west corner of this cell.
    [[nodiscard]] bool isPinch(int column, int row) const;
    /// Returns half the side of the square without ground around each such corner [probe unit].
    [[nodiscard]] std::int32_t bridge() const { return bridge_; }

private:
    [[nodiscard]] bool holds(std::int64_t x, std::int64_t y, int scale) const;

    Cells cells_;
    std::vector<Run> runs_;
    std::vector<std::uint32_t> firstRun_;  // index of each row's first run, and the number of runs
    std::int32_t bridge_;
    std::vector<Part> outline_;            // level parts from south to north, upright ones from west to east, pinches
    std::size_t level_ = 0, upright_ = 0;  // ends of the level and of the upright parts in outline_
};

}  // namespace sand::tin
