// SPDX-License-Identifier: Apache-2.0
#include "shapes/tin/relief.hpp"

#include <algorithm>
#include <utility>

#include "sand/model/height_field.hpp"

namespace shapes {
namespace {

using sand::tin::doubledArea;
using sand::tin::LatticePoint;

constexpr std::int64_t kCellSide = sand::kProbePerCell;

constexpr int cellsOf(std::int32_t length) {
    return std::max<int>(1, static_cast<int>((length + kCellSide / 2) / kCellSide));
}

std::int64_t floorOf(std::int64_t dividend, std::int64_t divisor /* positive */) {
    return dividend >= 0 ? dividend / divisor : -((-dividend + divisor - 1) / divisor);
}

LatticePoint middleOf(std::int64_t column, std::int64_t row) {
    return {static_cast<std::int32_t>(column * kCellSide + kCellSide / 2),
            static_cast<std::int32_t>(row * kCellSide + kCellSide / 2)};
}

struct Columns {
    std::int64_t first, end;
};

/// Keeps the columns of a row whose middles are left of the edge. Keeps a middle on the edge only if the edge leads
/// south or west. So exactly one of the two triangles beside the edge has it.
void clip(Columns& columns, std::int64_t row, const LatticePoint& from, const LatticePoint& to) {
    const std::int64_t south = std::int64_t{from.y} - to.y;
    const bool within = south > 0 || (south == 0 && to.x < from.x);
    // A middle is kept if its doubled area is at least 0, or at least 1 if a middle on the edge is not kept. The test
    // is atFirst + slope · column ≥ 0.
    const std::int64_t atFirst = doubledArea(from, to, middleOf(0, row)) - (within ? 0 : 1);
    const std::int64_t slope = south * kCellSide;
    if (slope > 0) {
        columns.first = std::max(columns.first, -floorOf(atFirst, slope));
    } else if (slope < 0) {
        columns.end = std::min(columns.end, floorOf(atFirst, -slope) + 1);
    } else if (atFirst < 0) {
        columns.end = columns.first;
    }
}

}  // namespace

TinRelief::TinRelief(std::int32_t width, std::int32_t depth)
    : columns_(cellsOf(width)),
      rows_(cellsOf(depth)),
      tilesAcross_((columns_ + kTile - 1) / kTile),
      heights_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      changed_(static_cast<std::size_t>(tilesAcross_) * static_cast<std::size_t>((rows_ + kTile - 1) / kTile)) {}

void TinRelief::put(const std::array<ReliefCorner, 3>& corners) {
    const auto& [a, b, c] = corners;
    const auto [south, north] = std::minmax({a.place.y, b.place.y, c.place.y});
    const auto whole = static_cast<double>(doubledArea(a.place, b.place, c.place));
    const std::int64_t lastRow = std::min<std::int64_t>(rows_ - 1, floorOf(north - kCellSide / 2, kCellSide));
    for (std::int64_t row = std::max<std::int64_t>(0, floorOf(south - kCellSide / 2, kCellSide)); row <= lastRow;
         ++row) {
        Columns columns{0, columns_};
        clip(columns, row, a.place, b.place);
        clip(columns, row, b.place, c.place);
        clip(columns, row, c.place, a.place);
        for (std::int64_t column = columns.first; column < columns.end; ++column) {
            const LatticePoint middle = middleOf(column, row);
            const double sum = static_cast<double>(doubledArea(b.place, c.place, middle)) * a.height +
                               static_cast<double>(doubledArea(c.place, a.place, middle)) * b.height +
                               static_cast<double>(doubledArea(a.place, b.place, middle)) * c.height;
            set(static_cast<int>(column), static_cast<int>(row), static_cast<float>(sum / whole));
        }
    }
}

void TinRelief::set(int column, int row, float height) {
    float& here =
        heights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
    if (here == height) {
        return;
    }
    here = height;
    const int tile = row / kTile * tilesAcross_ + column / kTile;
    sand::CellRect& changed = changed_[static_cast<std::size_t>(tile)];
    if (changed.empty()) {
        changedTiles_.push_back(tile);
    }
    changed = changed.joinedWith({column, row, column + 1, row + 1});
}

TinRelief::Between TinRelief::between(std::int32_t x, std::int32_t y) {
    const auto along = [](std::int32_t place, int& cell) {
        const std::int64_t from = place - kCellSide / 2;
        const std::int64_t before = floorOf(from, kCellSide);
        cell = static_cast<int>(before);
        return static_cast<float>(from - before * kCellSide) / static_cast<float>(kCellSide);
    };
    Between place{};
    place.alongX = along(x, place.column);
    place.alongY = along(y, place.row);
    return place;
}

float TinRelief::at(const Between& place, int east, int north) const {
    const int column = place.column + east, row = place.row + north;
    const int westOf = std::clamp(column, 0, columns_ - 1), eastOf = std::clamp(column + 1, 0, columns_ - 1);
    const int southOf = std::clamp(row, 0, rows_ - 1), northOf = std::clamp(row + 1, 0, rows_ - 1);
    return linear(place, cell(westOf, southOf), cell(eastOf, southOf), cell(westOf, northOf), cell(eastOf, northOf));
}

std::vector<sand::CellRect> TinRelief::takeChanged() {
    std::vector<sand::CellRect> all;
    for (const int tile : changedTiles_) {
        all.push_back(std::exchange(changed_[static_cast<std::size_t>(tile)], {}));
    }
    changedTiles_.clear();
    return all;
}

}  // namespace shapes
