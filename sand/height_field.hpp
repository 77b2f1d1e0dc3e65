// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sand {

inline constexpr int kMaxSide = 16384;               // [cell]
inline constexpr std::int32_t kMaxHeight = 1 << 28;  // [unit], of either sign
inline constexpr int kHeightBits = 16;               // one height unit is cellSize / 2^16
inline constexpr int kProbeBits = 8;                 // one probe unit is cellSize / 2^8
inline constexpr std::int32_t kUnitsPerCell = 1 << kHeightBits;
inline constexpr std::int32_t kProbePerCell = 1 << kProbeBits;

/// Cells of a half-open rectangle: columns [x0, x1), rows [y0, y1).
struct Rect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
    /// The part of it that lies in `other`.
    [[nodiscard]] Rect clippedTo(const Rect& other) const;
    friend bool operator==(const Rect&, const Rect&) = default;
};

/// Sand on a regular grid of square cells, the same on every rank.
///
/// Heights are fixed-point: one unit is cellSize / 2^16. Cell (0,0) is the south-west corner; columns run east, rows
/// north. Each row carries one ghost cell at either end, and there is a ghost row below and above, which belong to
/// Erosion. Not thread-safe.
class HeightField {
public:
    /// Level ground at height 0. Throws std::invalid_argument when a side is outside [1, kMaxSide] or cellSize is not
    /// positive and finite; scenes are checked before, with file and line.
    HeightField(int columns, int rows, double cellSize /* [scene unit] */);

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] double cellSize() const { return cellSize_; }              // [scene unit]
    [[nodiscard]] double unit() const { return cellSize_ / kUnitsPerCell; }  // [scene unit], of one height unit
    [[nodiscard]] Rect bounds() const { return {0, 0, columns_, rows_}; }

    [[nodiscard]] std::int32_t height(int column, int row) const { return this->row(row)[column]; }  // [unit]
    void setHeight(int column, int row, std::int32_t height) { this->row(row)[column] = height; }    // [unit]

    /// Cell 0 of a row in [-1, rows]; cells -1 and columns are the ghosts.
    [[nodiscard]] const std::int32_t* row(int row) const { return cells_.data() + offset(row); }
    [[nodiscard]] std::int32_t* row(int row) { return cells_.data() + offset(row); }

    /// From a row to the next [cell]. Whoever reads a row by vectors may read kPadding cells beyond either end.
    [[nodiscard]] std::ptrdiff_t stride() const {
        return 2 * kPadding + (columns_ + kPadding - 1) / kPadding * kPadding;
    }

    /// The sum of all heights [unit · cell], exact.
    [[nodiscard]] std::int64_t volume() const;

    /// Exchanges the heights of two fields of one size; no cell is copied.
    void swapHeights(HeightField& other) noexcept { cells_.swap(other.cells_); }

    friend bool sameHeights(const HeightField& a, const HeightField& b);

private:
    // A row: a vector of padding that ends in a ghost, the cells up to a whole vector, a vector that begins with a
    // ghost or holds the last of it.
    static constexpr int kPadding = 16;  // [cell], one cache line

    [[nodiscard]] std::ptrdiff_t offset(int row) const { return (row + std::ptrdiff_t{1}) * stride() + kPadding; }

    int columns_;
    int rows_;
    double cellSize_;
    std::vector<std::int32_t> cells_;
};

}  // namespace sand
