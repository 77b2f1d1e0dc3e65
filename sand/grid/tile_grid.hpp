// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>

#include "sand/model/cell_array.hpp"

namespace sand::grid {

/// Division of a field into tiles of kTile x kTile cells, row by row from the south-west. The last tile of a row and
/// the tiles of the last row may be smaller.
class TileGrid {
public:
    static constexpr int kTile = 64;  // side of a tile [cell]

    explicit TileGrid(const CellRect& field) : field_(field), across_(along(field.x1)) {}

    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(across_) * static_cast<std::size_t>(along(field_.y1));
    }
    [[nodiscard]] const CellRect& field() const { return field_; }
    [[nodiscard]] std::size_t tileAt(int column, int row) const {
        return static_cast<std::size_t>(row / kTile) * static_cast<std::size_t>(across_) +
               static_cast<std::size_t>(column / kTile);
    }
    [[nodiscard]] CellRect cellsOf(std::size_t tile) const {
        const auto across = static_cast<std::size_t>(across_);
        const int x = static_cast<int>(tile % across) * kTile, y = static_cast<int>(tile / across) * kTile;
        return CellRect{x, y, x + kTile, y + kTile}.clippedTo(field_);
    }
    /// Calls visit(tile) for each tile that has a cell of `cells`.
    template <class Visit>
    void forEach(const CellRect& cells, const Visit& visit) const {
        const CellRect inside = cells.clippedTo(field_);
        if (inside.empty()) {
            return;
        }
        for (int y = inside.y0 / kTile; y < along(inside.y1); ++y) {
            for (int x = inside.x0 / kTile; x < along(inside.x1); ++x) {
                visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(x));
            }
        }
    }

private:
    static int along(int cells) { return (cells + kTile - 1) / kTile; }

    CellRect field_;
    int across_;  // tiles in a row
};

}  // namespace sand::grid
