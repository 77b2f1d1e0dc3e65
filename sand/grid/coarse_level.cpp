// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/coarse_level.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace sand::grid {
namespace {

/// Adds `each` to all cells.
void add(HeightField& field, const CellRect& cells, std::int32_t each) {
    for (int y = cells.y0; y < cells.y1; ++y) {
        std::int32_t* const row = field.row(y);
        for (int x = cells.x0; x < cells.x1; ++x) {
            row[x] += each;
        }
    }
}

}  // namespace

CoarseLevel::CoarseLevel(const Site& site, const CellRect& patch, int side)
    : site_(site),
      side_(side),
      across_(axisOf(patch.x0, patch.x1, site.field.columns())),
      down_(axisOf(patch.y0, patch.y1, site.field.rows())) {
    if (across_.count <= 0 || down_.count <= 0) {
        return;
    }
    heights_.emplace(columns(), rows(), site.field.cellSize() * side);
    if (site.ground != nullptr || across_.before + across_.after + down_.before + down_.after > 0) {
        ground_.emplace(columns(), rows());
    }
    groupCells();
    fill();
}

CoarseLevel::Axis CoarseLevel::axisOf(int from, int end, int cells) const {
    const int low = std::max(from, 0), high = std::min(end, cells);
    const bool mirrored = low > cells - high;  // the far rim is nearer
    const int near = mirrored ? cells - high : low, far = mirrored ? cells - low : high;
    const int first = near / side_, last = std::min((far + side_ - 1) / side_, cells / side_);
    Axis axis{mirrored ? cells - last * side_ : first * side_, last - first};
    // An open rim has its outflow; the other edges of the patch are closed by walls.
    const bool open = site_.rules.rim == Rim::open;
    axis.before = open && axis.first > 0 ? 1 : 0;
    axis.after = open && axis.first + axis.count * side_ < cells ? 1 : 0;
    return axis;
}

CellRect CoarseLevel::cellsOf(int column, int row) const {
    const int x = across_.first + (column - across_.before) * side_, y = down_.first + (row - down_.before) * side_;
    return {x, y, x + side_, y + side_};
}

std::int32_t CoarseLevel::lowest(int x, int y, std::int32_t least) const {
    return site_.ground == nullptr ? least : std::max(least, site_.ground->bedrock(x, y));
}

std::int32_t CoarseLevel::highest(int x, int y, std::int32_t cap) const {
    const Obstacle* const tool = site_.obstacle;
    if (tool == nullptr || x < tool->cells.x0 || x >= tool->cells.x1 || y < tool->cells.y0 || y >= tool->cells.y1) {
        return cap;
    }
    const std::int32_t under = tool->row(y)[x - tool->cells.x0];
    return under == Obstacle::kFree ? cap : std::max(std::min(under, cap), site_.field.height(x, y));
}

bool CoarseLevel::isBelowTool(int column, int row) const {
    return !obstacle_.cells.clippedTo({column, row, column + 1, row + 1}).empty() &&
           obstacle_.row(row)[column - obstacle_.cells.x0] != Obstacle::kFree;
}

std::int32_t CoarseLevel::capOf(int column, int row) const {
    if (!isBelowTool(column, row)) {
        return highest_;
    }
    std::int32_t cap = -kMaxHeight;
    forEach(CellRect{column - 1, row - 1, column + 2, row + 2}.clippedTo(inner()),
            [&](int x, int y) { cap = std::max(cap, groupAt(x, y).highest); });
    return cap;
}

CoarseLevel::Result CoarseLevel::sweep(int sweeps) {
    Result result;
    if (!heights_) {
        return result;
    }
    const HeightField before = *heights_;
    Rules rules = site_.rules;
    const auto larger = [this](std::int32_t threshold) {
        return static_cast<std::int32_t>(std::min<std::int64_t>(std::int64_t{threshold} * side_, kLargestThreshold));
    };
    rules.columns = columns();
    rules.rows = rows();
    rules.tuning.threshold = larger(rules.tuning.threshold);
    rules.tuning.startThreshold = larger(rules.tuning.startThreshold);
    Erosion::Options how = site_.how;
    how.ground = ground_ ? &*ground_ : nullptr;
    Erosion erosion(*heights_, rules, how);
    const Obstacle* const tool = obstacle_.cells.empty() ? nullptr : &obstacle_;
    const std::int64_t area = std::int64_t{side_} * side_;
    result.outflow = area * erosion.sweep(*heights_, sweeps, tool);
    forEach(heights_->bounds(), [&](int column, int row) {
        const std::int64_t change = std::int64_t{heights_->height(column, row)} - before.height(column, row);
        if (change != 0) {
            shareOut(column, row, change);
            result.changed = result.changed.joinedWith(cellsOf(column, row));
        }
    });
    return result;
}

bool CoarseLevel::shareEvenly(int column, int row, std::int64_t each) {
    const Group& group = groupAt(column, row);
    const bool fits = each > 0 ? !isBelowTool(column, row) && group.highest + each <= highest_
                               : site_.ground == nullptr && group.lowest + each >= lowest_;
    if (fits) {
        add(site_.field, cellsOf(column, row), static_cast<std::int32_t>(each));
    }
    return fits;
}

/// Shares out a change of `each` per cell evenly over the cells that have room for it, until nothing is left. Sand that
/// falls over an open rim may leave a cell lower than all of the patch.
void CoarseLevel::shareOut(int column, int row, std::int64_t each) {
    if (shareEvenly(column, row, each)) {
        return;
    }
    const std::int64_t change = each * side_ * side_;
    const CellRect cells = cellsOf(column, row);
    std::int32_t least = lowest_;
    const std::int32_t cap = capOf(column, row);
    const auto limit = [&](int x, int y) { return change > 0 ? highest(x, y, cap) : lowest(x, y, least); };
    std::int64_t left = change;
    while (left != 0) {
        std::int64_t count = 0;
        forEach(cells, [&](int x, int y) {
            const std::int32_t height = site_.field.height(x, y), most = limit(x, y);
            count += (change > 0 ? height < most : height > most) ? 1 : 0;
        });
        if (count == 0 && change < 0 && least > floor_) {
            least = floor_;
            continue;
        }
        if (count == 0) {  // the range, the rock and the underside of a coarse cell are those of its cells
            throw std::logic_error("CoarseLevel: the change of a coarse cell does not fit into its cells");
        }
        const std::int64_t share = left / count;
        std::int64_t odd = left - share * count;
        forEach(cells, [&](int x, int y) {
            const std::int64_t height = site_.field.height(x, y), most = limit(x, y);
            if (left == 0 || !(change > 0 ? height < most : height > most)) {
                return;
            }
            const std::int64_t wanted = height + share + (odd > 0 ? 1 : odd < 0 ? -1 : 0);
            odd -= odd > 0 ? 1 : odd < 0 ? -1 : 0;
            const std::int64_t now = change > 0 ? std::min(wanted, most) : std::max(wanted, most);
            site_.field.setHeight(x, y, static_cast<std::int32_t>(now));
            left -= now - height;
        });
    }
}

}  // namespace sand::grid
