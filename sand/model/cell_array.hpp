// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sand {

/// Cells of a half-open rectangle: columns [x0, x1), rows [y0, y1).
struct CellRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
    /// The part of it that lies in `other`.
    [[nodiscard]] CellRect clippedTo(const CellRect& other) const;
    /// The smallest around both; an empty one counts for nothing.
    [[nodiscard]] CellRect joinedWith(const CellRect& other) const;
    /// With `margin` more cells on every side.
    [[nodiscard]] CellRect grownBy(int margin) const { return {x0 - margin, y0 - margin, x1 + margin, y1 + margin}; }
    friend bool operator==(const CellRect&, const CellRect&) = default;
};

/// A 32-bit number per cell, with ghost cells around: rows -1 and `rows`, columns -1 and `columns`.
///
/// Cell (0,0) is the south-west corner; columns run east, rows north. Starts as zeros. Not thread-safe.
class CellArray {
public:
    CellArray(int columns, int rows)
        : columns_(columns),
          rows_(rows),
          cells_(static_cast<std::size_t>(stride()) * (static_cast<std::size_t>(rows) + 2)) {}

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] CellRect bounds() const { return {0, 0, columns_, rows_}; }

    /// Cell 0 of a row in [-1, rows]; cells -1 and columns are ghosts.
    [[nodiscard]] const std::int32_t* row(int row) const { return cells_.data() + offset(row); }
    [[nodiscard]] std::int32_t* row(int row) { return cells_.data() + offset(row); }

    /// From a row to the next [cell]. Whoever reads a row by vectors may read kPadding cells beyond either end.
    [[nodiscard]] std::ptrdiff_t stride() const {
        return 2 * kPadding + (columns_ + kPadding - 1) / kPadding * kPadding;
    }
    [[nodiscard]] std::size_t bytes() const { return cells_.size() * sizeof cells_[0]; }

private:
    // A row: a vector of padding that ends in a ghost, the cells up to a whole vector, a vector that begins with a
    // ghost or holds the last of it.
    static constexpr int kPadding = 16;  // [cell], one cache line

    [[nodiscard]] std::ptrdiff_t offset(int row) const { return (row + std::ptrdiff_t{1}) * stride() + kPadding; }

    int columns_;
    int rows_;
    std::vector<std::int32_t> cells_;
};

}  // namespace sand
