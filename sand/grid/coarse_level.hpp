// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

/// One level of a coarse phase: sand slides over a patch of the field, on square groups of cells.
///
/// A coarse cell is as high as the mean of its cells. Its change is shared out over them. So the volume is exact. No
/// cell leaves the range of the patch's heights, except where sand falls over an open rim. No cell goes below its rock
/// or rises into the tool. A coarse cell with a wall or a cliff of rock is a wall. Coarse cells are counted from the
/// nearer rim of the field on each axis. Cells that are left over lie at the farther rim. Used by one thread.
class CoarseLevel {
public:
    /// The field, and ground and obstacle, which may be null. All must outlive the level.
    struct Site {
        HeightField& field;
        const Rules& rules;
        const Ground* ground;
        const Obstacle* obstacle;
        Erosion::Options how;  // of the coarse cells; `ground` is ignored
    };
    /// `side` is the side of a coarse cell [cell].
    CoarseLevel(const Site& site, const CellRect& patch, int side);

    struct Result {
        CellRect changed;          // cells that may have changed
        std::int64_t outflow = 0;  // volume that fell over an open rim [unit · cell]
    };
    /// Runs `sweeps` sweeps.
    Result sweep(int sweeps);

private:
    /// Cells along one axis: `count` coarse cells from cell `first`. Up to one coarse cell of wall lies before and
    /// after them.
    struct Axis {
        int first = 0, count = 0, before = 0, after = 0;
    };
    /// Sum and range of the heights in a coarse cell before it changes.
    struct Group {
        std::int64_t sum = 0;                                     // [unit]
        std::int32_t lowest = kMaxHeight, highest = -kMaxHeight;  // [unit]
    };
    /// Returns a / b, rounded down. `b` is positive.
    [[nodiscard]] static std::int64_t floorOf(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
    /// Calls visit(x, y) for each cell of `cells`, row by row.
    template <class Visit>
    static void forEach(const CellRect& cells, const Visit& visit) {
        for (int y = cells.y0; y < cells.y1; ++y) {
            for (int x = cells.x0; x < cells.x1; ++x) {
                visit(x, y);
            }
        }
    }
    [[nodiscard]] Axis axisOf(int from, int end, int cells) const;
    [[nodiscard]] CellRect cellsOf(int column, int row) const;
    [[nodiscard]] int columns() const { return across_.before + across_.count + across_.after; }
    [[nodiscard]] int rows() const { return down_.before + down_.count + down_.after; }

    /// Returns the coarse cells that are not walls at the edges of the patch.
    [[nodiscard]] CellRect inner() const {
        return {across_.before, down_.before, across_.before + across_.count, down_.before + down_.count};
    }
    [[nodiscard]] const Group& groupAt(int column, int row) const {
        return groups_[static_cast<std::size_t>(row - down_.before) * static_cast<std::size_t>(across_.count) +
                       static_cast<std::size_t>(column - across_.before)];
    }

    /// Returns the lowest height to which a cell may go, at least `least`.
    [[nodiscard]] std::int32_t lowest(int x, int y, std::int32_t least) const;
    /// Returns the highest height to which a cell may go, of a coarse cell with this `cap`.
    [[nodiscard]] std::int32_t highest(int x, int y, std::int32_t cap) const;
    /// Returns whether some cells of a coarse cell are below the tool.
    [[nodiscard]] bool isBelowTool(int column, int row) const;
    /// Returns the highest height to which a cell of a coarse cell may go that is not below the tool.
    [[nodiscard]] std::int32_t capOf(int column, int row) const;
    template <class Side>
    [[nodiscard]] Group groupFrom(int x, int y, Side side) const;
    void groupCells();
    void fill();
    void makeObstacle();
    [[nodiscard]] bool hasCliff(int x, int y) const;
    void fillGround(int column, int row);
    void fillObstacle(int column, int row, std::int64_t sand);
    [[nodiscard]] std::int64_t roomOf(const CellRect& cells, const CellRect& below, std::int32_t cap) const;
    /// Does what shareOut() does if it is clear that all cells have room. Returns whether it did.
    bool shareEvenly(int column, int row, std::int64_t each);
    void shareOut(int column, int row, std::int64_t each);

    Site site_;
    int side_;
    Axis across_, down_;
    std::int32_t lowest_ = 0, highest_ = 0;  // of the patch [unit]
    std::int32_t floor_ = 0;                 // lowest height that sand without rock can come to [unit]
    std::optional<HeightField> heights_;     // nullopt if the patch has less than a coarse cell
    std::optional<Ground> ground_;
    Obstacle obstacle_{};
    std::vector<Group> groups_;  // of inner(), row by row
};

}  // namespace sand::grid
