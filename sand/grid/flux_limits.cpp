// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/flux_limits.hpp"

#include <algorithm>

#include "sand/grid/erosion_kernel.hpp"

namespace sand::grid {
namespace {

constexpr std::size_t kReadBeyond = 2 * kVector;  // [cell], by a loop over whole vectors

/// Copies the cells of a row that lie in the field. The loop has no branch, because with rock it is most of a sweep's
/// cost.
void copyRow(const std::int32_t* __restrict field, const std::int32_t* __restrict bed, int count,
             std::int32_t* __restrict heights, std::int32_t* __restrict sand, std::int32_t* __restrict room) {
    for (int i = 0; i < count; ++i) {
        const bool wall = bed[i] == Ground::kWall;
        heights[i] = wall ? kMaxHeight : field[i];
        sand[i] = wall ? 0 : field[i] - bed[i];
        room[i] = wall ? 0 : Obstacle::kFree;
    }
}

/// Limits the room of the cells below the tool. Cells beside the tool have no limit. The loop has no branch, because
/// with rock it is most of a sweep's cost.
void keepRowBelow(const std::int32_t* __restrict undersides, const std::int32_t* __restrict heights, int count,
                  std::int32_t* __restrict room) {
    for (int i = 0; i < count; ++i) {
        room[i] = std::min(room[i], std::max(undersides[i] - heights[i], 0));
    }
}

}  // namespace

FluxLimits::FluxLimits(const HeightField& field, const CellRect& cells, const Ground& ground, const Obstacle* obstacle)
    : grown_(cells.grownBy(1)) {
    const std::size_t cellCount =
        static_cast<std::size_t>(grown_.x1 - grown_.x0) * static_cast<std::size_t>(grown_.y1 - grown_.y0);
    room.resize(cellCount + kReadBeyond);
    heights.resize(room.size());
    sand.resize(room.size());
    copyField(field, ground);
    if (obstacle != nullptr) {
        keepBelow(field, *obstacle);
    }
    extendBeyondRim(field);
}

std::size_t FluxLimits::index(int column, int row) const {
    return static_cast<std::size_t>(row - grown_.y0) * static_cast<std::size_t>(grown_.x1 - grown_.x0) +
           static_cast<std::size_t>(column - grown_.x0);
}

void FluxLimits::copyField(const HeightField& field, const Ground& ground) {
    const CellRect inside = grown_.clippedTo(field.bounds());
    for (int y = inside.y0; y < inside.y1; ++y) {
        const std::size_t first = index(inside.x0, y);
        copyRow(field.row(y) + inside.x0, ground.cells().row(y) + inside.x0, inside.x1 - inside.x0, &heights[first],
                &sand[first], &room[first]);
    }
}

void FluxLimits::extendBeyondRim(const HeightField& field) {
    for (int y = grown_.y0; y < grown_.y1; ++y) {
        const bool rowInside = y >= 0 && y < field.rows();
        for (int x = grown_.x0; x < grown_.x1; ++x) {
            if (rowInside && x >= 0 && x < field.columns()) {
                x = std::min(grown_.x1, field.columns()) - 1;  // the last cell that copyField() has copied
                continue;
            }
            const std::size_t nearest =
                index(std::clamp(x, 0, field.columns() - 1), std::clamp(y, 0, field.rows() - 1));
            heights[index(x, y)] = heights[nearest];
            sand[index(x, y)] = sand[nearest];
            room[index(x, y)] = room[nearest];
        }
    }
}

void FluxLimits::keepBelow(const HeightField& field, const Obstacle& obstacle) {
    const CellRect shared = obstacle.cells.clippedTo(grown_);
    for (int y = shared.y0; y < shared.y1 && shared.x0 < shared.x1; ++y) {
        keepRowBelow(obstacle.row(y) + (shared.x0 - obstacle.cells.x0), field.row(y) + shared.x0, shared.x1 - shared.x0,
                     &room[index(shared.x0, y)]);
    }
}

}  // namespace sand::grid
