// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <type_traits>

#include "sand/grid/coarse_level.hpp"

namespace sand::grid {

/// Returns sum and range of the square cells from x, y. A side that the compiler knows takes a third of the time.
template <class Side>
CoarseLevel::Group CoarseLevel::groupFrom(int x, int y, Side side) const {
    Group group;
    for (int row = 0; row < side; ++row) {
        const std::int32_t* const cells = site_.field.row(y + row) + x;
        for (int i = 0; i < side; ++i) {
            group.sum += cells[i];
            group.lowest = std::min(group.lowest, cells[i]);
            group.highest = std::max(group.highest, cells[i]);
        }
    }
    return group;
}

void CoarseLevel::groupCells() {
    groups_.reserve(static_cast<std::size_t>(across_.count) * static_cast<std::size_t>(down_.count));
    lowest_ = kMaxHeight;
    highest_ = -kMaxHeight;
    forEach(inner(), [this](int column, int row) {
        const CellRect cells = cellsOf(column, row);
        const Group group = side_ == 2   ? groupFrom(cells.x0, cells.y0, std::integral_constant<int, 2>{})
                            : side_ == 4 ? groupFrom(cells.x0, cells.y0, std::integral_constant<int, 4>{})
                            : side_ == 8 ? groupFrom(cells.x0, cells.y0, std::integral_constant<int, 8>{})
                                         : groupFrom(cells.x0, cells.y0, side_);
        lowest_ = std::min(lowest_, group.lowest);
        highest_ = std::max(highest_, group.highest);
        groups_.push_back(group);
    });
    floor_ = site_.rules.rim == Rim::open ? -kMaxHeight : lowest_;
}

void CoarseLevel::fill() {
    makeObstacle();
    forEach({0, 0, columns(), rows()}, [this](int column, int row) {
        const CellRect cell{column, row, column + 1, row + 1};
        if (cell.clippedTo(inner()).empty()) {
            ground_->setWall(column, row);
            return;
        }
        const std::int64_t sand = groupAt(column, row).sum;
        heights_->setHeight(column, row, static_cast<std::int32_t>(floorOf(sand, std::int64_t{side_} * side_)));
        if (site_.ground != nullptr) {
            fillGround(column, row);
        }
        if (!obstacle_.cells.clippedTo(cell).empty()) {
            fillObstacle(column, row, sand);
        }
    });
    if (!obstacle_.cells.empty()) {
        obstacle_.findReached();
    }
}

/// Makes an obstacle of free cells over the coarse cells that may be below the tool.
void CoarseLevel::makeObstacle() {
    if (site_.obstacle == nullptr || site_.obstacle->cells.empty()) {
        return;
    }
    const CellRect& below = site_.obstacle->cells;
    const auto coarse = [this](int cell, const Axis& axis) {
        return static_cast<int>(floorOf(cell - axis.first, side_)) + axis.before;
    };
    obstacle_.cells = CellRect{coarse(below.x0, across_), coarse(below.y0, down_), coarse(below.x1 - 1, across_) + 1,
                               coarse(below.y1 - 1, down_) + 1}
                          .clippedTo(inner());
    if (!obstacle_.cells.empty()) {
        const int padded = obstacle_.cells.y1 - obstacle_.cells.y0 + 2 * Obstacle::kRowsBeside;
        obstacle_.underside.assign(static_cast<std::size_t>(obstacle_.stride()) * static_cast<std::size_t>(padded),
                                   Obstacle::kFree);
    }
}

/// Returns whether the rock of a cell is too steep for sand on the side of a neighbour.
bool CoarseLevel::hasCliff(int x, int y) const {
    const std::int32_t rock = site_.ground->bedrock(x, y);
    const auto lower = [&](int beside, int row) {
        if (!CellRect{beside, row, beside + 1, row + 1}.clippedTo(site_.field.bounds()).empty()) {
            return !site_.ground->isWall(beside, row) &&
                   std::int64_t{site_.field.height(beside, row)} + site_.rules.tuning.threshold < rock;
        }
        return site_.rules.rim == Rim::open && site_.rules.tuning.threshold < rock;  // sand falls to height 0 there
    };
    return rock > lowest_ && (lower(x - 1, y) || lower(x + 1, y) || lower(x, y - 1) || lower(x, y + 1));
}

void CoarseLevel::fillGround(int column, int row) {
    std::int64_t least = 0;
    bool wall = false, rock = false;
    forEach(cellsOf(column, row), [&](int x, int y) {
        // A cliff would count as sand that slides, in a coarse cell that has sand beside it.
        wall |= site_.ground->isWall(x, y) || hasCliff(x, y);
        rock |= site_.ground->bedrock(x, y) > floor_;
        least += lowest(x, y, floor_);
    });
    if (wall) {
        ground_->setWall(column, row);
    } else if (rock) {
        // Rounded up, so that the sand above it is never more than that of the cells.
        const auto mean = static_cast<std::int32_t>(-floorOf(-least, std::int64_t{side_} * side_));
        ground_->setBedrock(column, row, std::min(mean, heights_->height(column, row)));
    }
}

/// Sets the underside so that the room below it is that of the cells. `sand` is the sum of their heights.
void CoarseLevel::fillObstacle(int column, int row, std::int64_t sand) {
    const CellRect cells = cellsOf(column, row), below = cells.clippedTo(site_.obstacle->cells);
    bool free = true;
    for (int y = below.y0; y < below.y1; ++y) {
        const std::int32_t* const under = site_.obstacle->row(y) + (below.x0 - site_.obstacle->cells.x0);
        free = free && std::all_of(under, under + (below.x1 - below.x0),
                                   [](std::int32_t height) { return height == Obstacle::kFree; });
    }
    if (free) {
        return;
    }
    const auto first = static_cast<std::size_t>(obstacle_.row(row) - obstacle_.underside.data());
    std::int32_t& under = obstacle_.underside[first + static_cast<std::size_t>(column - obstacle_.cells.x0)];
    under = heights_->height(column, row);  // no longer free, as capOf() asks
    under += static_cast<std::int32_t>(
        floorOf(roomOf(cells, below, capOf(column, row)) - sand, std::int64_t{side_} * side_));
}

/// Returns the sum of highest() over `cells`. Only the cells of `below` may be below the tool.
std::int64_t CoarseLevel::roomOf(const CellRect& cells, const CellRect& below, std::int32_t cap) const {
    const std::int64_t area = std::int64_t{cells.x1 - cells.x0} * (cells.y1 - cells.y0);
    std::int64_t room = (area - std::int64_t{below.x1 - below.x0} * (below.y1 - below.y0)) * cap;
    for (int y = below.y0; y < below.y1; ++y) {
        const std::int32_t* const under = site_.obstacle->row(y) + (below.x0 - site_.obstacle->cells.x0);
        const std::int32_t* const height = site_.field.row(y) + below.x0;
        for (int i = 0; i < below.x1 - below.x0; ++i) {
            room += under[i] == Obstacle::kFree ? cap : std::max(std::min(under[i], cap), height[i]);
        }
    }
    return room;
}

}  // namespace sand::grid
