// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "sand/model/cell_array.hpp"
#include "sand/model/units.hpp"

namespace sand {

/// Sand on a regular grid, the same on every rank.
///
/// Heights are fixed-point: one unit is cellSize / 2^16. Cell (0,0) is the south-west corner; columns run east, rows
/// north. Cells are square unless Rules::aspect says otherwise. The ghost cells around belong to Erosion. Not
/// thread-safe.
class HeightField {
public:
    /// Level ground at height 0. Throws std::invalid_argument when a side is outside [1, kMaxSide] or cellSize is not
    /// positive and finite; scenes are checked before, with file and line.
    HeightField(int columns, int rows, double cellSize /* [scene unit] */);

    [[nodiscard]] int columns() const { return cells_.columns(); }
    [[nodiscard]] int rows() const { return cells_.rows(); }
    [[nodiscard]] double cellSize() const { return cellSize_; }              // [scene unit], east to west
    [[nodiscard]] double unit() const { return cellSize_ / kUnitsPerCell; }  // [scene unit], of one height unit
    [[nodiscard]] CellRect bounds() const { return cells_.bounds(); }

    [[nodiscard]] std::int32_t height(int column, int row) const { return cells_.row(row)[column]; }  // [unit]
    void setHeight(int column, int row, std::int32_t height) { cells_.row(row)[column] = height; }    // [unit]

    /// The first cell of a row; row -1 and row `rows` are ghost cells, as in CellArray.
    [[nodiscard]] const std::int32_t* row(int row) const { return cells_.row(row); }
    [[nodiscard]] std::int32_t* row(int row) { return cells_.row(row); }
    [[nodiscard]] std::ptrdiff_t stride() const { return cells_.stride(); }
    [[nodiscard]] const CellArray& cells() const { return cells_; }
    [[nodiscard]] CellArray& cells() { return cells_; }

    /// The sum of all heights [unit · cell], exact.
    [[nodiscard]] std::int64_t volume() const;

    friend bool sameHeights(const HeightField& a, const HeightField& b);

private:
    double cellSize_;
    CellArray cells_;
};

}  // namespace sand
