// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/flux_limits.hpp"

#include <algorithm>

namespace sand::grid {
namespace {

/// Returns the height that the slope law uses for a cell. Beyond the rim the slope of the ground continues. There a
/// step counts at most the sand of its upper cell, so that the ground behind a cliff continues level. A wall continues
/// as a wall.
std::int32_t seenHeight(const HeightField& field, const Ground& ground, int x, int y) {
    const int edgeX = std::clamp(x, 0, field.columns() - 1);
    const int edgeY = std::clamp(y, 0, field.rows() - 1);
    if (ground.isWall(edgeX, edgeY)) {
        return kMaxHeight;
    }
    const int innerX = std::clamp(2 * edgeX - x, 0, field.columns() - 1);
    const int innerY = std::clamp(2 * edgeY - y, 0, field.rows() - 1);
    const std::int32_t edge = field.height(edgeX, edgeY);
    const std::int32_t inner = field.height(innerX, innerY);
    const std::int32_t least = -ground.sand(innerX, innerY, inner), most = ground.sand(edgeX, edgeY, edge);
    return ground.isWall(innerX, innerY) ? edge : edge + std::clamp(edge - inner, least, most);
}

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

/// Limits the room of the cells below the tool. Each of a cell's four faces may bring a quarter of what fits under the
/// tool. Cells beside the tool have no limit. The loop has no branch, because with rock it is most of a sweep's cost.
void keepRowBelow(const std::int32_t* __restrict undersides, const std::int32_t* __restrict heights, int count,
                  std::int32_t* __restrict room) {
    for (int i = 0; i < count; ++i) {
        const std::int32_t fits = std::max(std::min(undersides[i], kMaxHeight) - heights[i], 0) / 4;
        room[i] = std::min(room[i], undersides[i] == Obstacle::kFree ? Obstacle::kFree : fits);
    }
}

}  // namespace

FluxLimits::FluxLimits(const HeightField& field, const CellRect& cells, const Ground* ground, const Obstacle* obstacle)
    : grown_(cells.grownBy(1)) {
    room.assign(static_cast<std::size_t>(grown_.x1 - grown_.x0) * static_cast<std::size_t>(grown_.y1 - grown_.y0),
                Obstacle::kFree);
    if (ground != nullptr) {
        heights.resize(room.size());
        sand.resize(room.size());
        copyField(field, *ground);
        extendBeyondRim(field, *ground);
    }
    if (obstacle != nullptr) {
        keepBelow(field, *obstacle);
    }
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

void FluxLimits::extendBeyondRim(const HeightField& field, const Ground& ground) {
    for (int y = grown_.y0; y < grown_.y1; ++y) {
        const bool rowInside = y >= 0 && y < field.rows();
        for (int x = grown_.x0; x < grown_.x1; ++x) {
            if (rowInside && x >= 0 && x < field.columns()) {
                x = std::min(grown_.x1, field.columns()) - 1;  // the last cell that copyField() has copied
                continue;
            }
            const int edgeX = std::clamp(x, 0, field.columns() - 1);
            const int edgeY = std::clamp(y, 0, field.rows() - 1);
            heights[index(x, y)] = seenHeight(field, ground, x, y);
            sand[index(x, y)] = ground.sand(edgeX, edgeY, field.height(edgeX, edgeY));
            room[index(x, y)] = ground.isWall(edgeX, edgeY) ? 0 : Obstacle::kFree;
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
