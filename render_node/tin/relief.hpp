// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sand/model/cell_array.hpp"
#include "sand/tin/geometry/triangles.hpp"

namespace render_node {

/// A corner of a triangle, in the order that all replicas agree on.
struct ReliefCorner {
    sand::tin::Place place;
    double height = 0;  // [unit]
};

/// The heights of a TIN over the middles of the field's cells: whoever asks how much sky a place sees looks around in
/// it, which a walk through triangles would make slow.
///
/// A cell's height is a function of the triangle that lies there, whatever came before. Not thread-safe.
class TinRelief {
public:
    TinRelief(std::int32_t width, std::int32_t depth /* [probe unit] */);

    /// Takes over the cells over whose middles a triangle lies, counter-clockwise from above; of two that share a
    /// middle, it is the same one's.
    void put(const std::array<ReliefCorner, 3>& corners);
    /// A place between four middles of cells.
    struct Between {
        int column, row;       // of the south-western one, which may lie beyond the field
        float alongX, alongY;  // 0 … 1
    };
    [[nodiscard]] static Between between(std::int32_t x, std::int32_t y);
    /// The height so many cells away from there, linear between four middles [unit]; beyond the field that of the last.
    [[nodiscard]] float at(const Between& place, int east, int north) const;
    /// Whether all within so many cells of a place lies between middles of the field's cells.
    [[nodiscard]] bool isWithin(const Between& place, int reach) const {
        return place.column >= reach && place.row >= reach && place.column + reach + 1 < columns_ &&
               place.row + reach + 1 < rows_;
    }
    /// at() where that is so: the same number, sooner.
    [[nodiscard]] float within(const Between& place, int east, int north) const {
        const float* south =
            &heights_[static_cast<std::size_t>(place.row + north) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(place.column + east)];
        const float* northern = south + columns_;
        return linear(place, south[0], south[1], northern[0], northern[1]);
    }

    /// Rectangles of cells that have other heights than when this was called last, each within a tile of kTile cells.
    [[nodiscard]] std::vector<sand::CellRect> takeChanged();

private:
    static constexpr int kTile = 32;  // [cell]
    /// Of two cells side by side, and of those north of them.
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
    std::vector<sand::CellRect> changed_;  // of each tile
    std::vector<int> changedTiles_;
};

}  // namespace render_node
