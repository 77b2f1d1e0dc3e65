// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sand/model/cell_array.hpp"
#include "sand/tin/geometry/triangles.hpp"

namespace shapes {

/// Corner of a triangle. All replicas give the corners in the same order.
struct ReliefCorner {
    sand::tin::LatticePoint place;
    double height = 0;  // [unit]
};

/// Heights of a TIN over the middles of the field's cells. The visible share of the sky is computed from it, because a
/// walk through triangles would be slow.
///
/// The height of a cell depends only on the triangle that covers the cell's middle now. Not thread-safe.
class TinRelief {
public:
    TinRelief(std::int32_t width, std::int32_t depth /* [probe unit] */);

    /// Sets the heights of all cells whose middles the triangle covers. Its corners are counter-clockwise from above.
    /// If two triangles share a middle, always the same one sets it.
    void put(const std::array<ReliefCorner, 3>& corners);
    /// Place between the middles of four cells.
    struct Between {
        int column, row;       // of the south-western cell, which may lie beyond the field
        float alongX, alongY;  // 0 … 1
    };
    [[nodiscard]] static Between between(std::int32_t x, std::int32_t y);
    /// Returns the height at a distance of `east` and `north` cells from `place`, linear between four middles [unit].
    /// Beyond the field it returns the height of the last cell.
    [[nodiscard]] float at(const Between& place, int east, int north) const;
    /// Returns whether everything within `reach` cells of a place lies between middles of the field's cells.
    [[nodiscard]] bool isWithin(const Between& place, int reach) const {
        return place.column >= reach && place.row >= reach && place.column + reach + 1 < columns_ &&
               place.row + reach + 1 < rows_;
    }
    /// Returns the same number as at(), but faster. Allowed only if isWithin() holds.
    [[nodiscard]] float within(const Between& place, int east, int north) const {
        const float* south =
            &heights_[static_cast<std::size_t>(place.row + north) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(place.column + east)];
        const float* northern = south + columns_;
        return linear(place, south[0], south[1], northern[0], northern[1]);
    }

    /// Returns rectangles of cells whose heights have changed since the last call, each within a tile of kTile × kTile
    /// cells.
    [[nodiscard]] std::vector<sand::CellRect> takeChanged();

private:
    static constexpr int kTile = 32;  // [cell]
    /// Interpolates between two neighbouring cells, `west` and `east`, and the two cells north of them.
    [[nodiscard]] static float linear(const Between& place, float west, float east, float northWest, float northEast) {
        const float below = west + place.alongX * (east - west);
        const float above = northWest + place.alongX * (northEast - northWest);
        return below + place.alongY * (above - below);
    }
    void set(int column, int row, float height);
    [[nodiscard]] float cell(int column, int row) const {
        return heights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                        static_cast<std::size_t>(column)];
    }

    int columns_, rows_, tilesAcross_;
    std::vector<float> heights_;           // [unit], row by row
    std::vector<sand::CellRect> changed_;  // changed cells of each tile
    std::vector<int> changedTiles_;
};

}  // namespace shapes
