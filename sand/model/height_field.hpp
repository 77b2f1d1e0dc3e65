// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "sand/model/cell_array.hpp"
#include "sand/model/units.hpp"

namespace sand {

/// Sand on a regular grid with one height per cell, the same on every rank.
///
/// Heights are fixed-point numbers: one unit is cellSize / 2^16. Cell (0,0) is the south-west corner; columns run east
/// and rows run north. Cells are square unless Rules::aspect gives another ratio. A border of ghost cells, one cell
/// wide, surrounds the field; Erosion writes it. Not thread-safe.
class HeightField {
public:
    /// Creates level sand at height 0. Throws std::invalid_argument if a side is outside [1, kMaxSide] or `cellSize` is
    /// not positive and finite. Scene files are checked earlier, by code that reports file and line.
    HeightField(int columns, int rows, double cellSize /* [scene unit] */);

    [[nodiscard]] int columns() const { return cells_.columns(); }
    [[nodiscard]] int rows() const { return cells_.rows(); }
    [[nodiscard]] double cellSize() const { return cellSize_; }              // [scene unit], from west to east
    [[nodiscard]] double unit() const { return cellSize_ / kUnitsPerCell; }  // [scene unit], size of a height unit
    [[nodiscard]] CellRect bounds() const { return cells_.bounds(); }

    [[nodiscard]] std::int32_t height(int column, int row) const { return cells_.row(row)[column]; }  // [unit]
    void setHeight(int column, int row, std::int32_t height) { cells_.row(row)[column] = height; }    // [unit]

    /// Returns the height at the place (x, y) [unit], interpolated between the centres of the four cells around it.
    /// Outside the centres of the outermost cells, returns the height of the nearest place between them.
    [[nodiscard]] double interpolated(double x, double y /* [probe unit] */) const;

    /// Returns a pointer to cell 0 of `row`. Rows -1 and rows() consist of ghost cells, as do columns -1 and columns().
    [[nodiscard]] const std::int32_t* row(int row) const { return cells_.row(row); }
    [[nodiscard]] std::int32_t* row(int row) { return cells_.row(row); }
    [[nodiscard]] std::ptrdiff_t stride() const { return cells_.stride(); }  // [cell], from one row to the next
    [[nodiscard]] const CellArray& cells() const { return cells_; }
    [[nodiscard]] CellArray& cells() { return cells_; }

    /// Returns the sum of all heights [unit · cell], which is exact.
    [[nodiscard]] std::int64_t volume() const;

    /// Returns whether both fields have the same size and the same heights. Ignores cell size and ghost cells.
    friend bool sameHeights(const HeightField& a, const HeightField& b);

private:
    double cellSize_;
    CellArray cells_;
};

}  // namespace sand
