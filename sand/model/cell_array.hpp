// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/zeroed_memory.hpp"

namespace sand {

/// Rectangle of cells: columns [x0, x1) and rows [y0, y1).
struct CellRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
    /// Returns the part of the rectangle that lies in `other`.
    [[nodiscard]] CellRect clippedTo(const CellRect& other) const {
        return {std::max(x0, other.x0), std::max(y0, other.y0), std::min(x1, other.x1), std::min(y1, other.y1)};
    }
    /// Returns the smallest rectangle that contains both. Ignores an empty rectangle.
    [[nodiscard]] CellRect joinedWith(const CellRect& other) const {
        if (empty() || other.empty()) {
            return empty() ? other : *this;
        }
        return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1), std::max(y1, other.y1)};
    }
    /// Returns the rectangle with `margin` more cells on every side.
    [[nodiscard]] CellRect grownBy(int margin) const { return {x0 - margin, y0 - margin, x1 + margin, y1 + margin}; }
    friend bool operator==(const CellRect&, const CellRect&) = default;
};

/// Array of one 32-bit number per cell. Ghost cells surround it: rows -1 and `rows`, columns -1 and `columns`.
///
/// Cell (0,0) is the south-west corner; columns run east and rows run north. All numbers are 0 at first. A large array
/// takes memory only for pages that were written. Not thread-safe.
class CellArray {
public:
    CellArray(int columns, int rows)
        : columns_(columns),
          rows_(rows),
          cells_(static_cast<std::size_t>(stride()) * (static_cast<std::size_t>(rows) + 2) * sizeof(std::int32_t)) {}

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] CellRect bounds() const { return {0, 0, columns_, rows_}; }

    /// Returns a pointer to cell 0 of `row`, which is in [-1, rows()]. Cells -1 and columns() are ghost cells.
    [[nodiscard]] const std::int32_t* row(int row) const { return numbers(cells_.data()) + offset(row); }
    [[nodiscard]] std::int32_t* row(int row) { return numbers(cells_.data()) + offset(row); }

    /// Returns the distance from one row to the next [cell]. Code that reads a row by vectors may read kPadding cells
    /// beyond either end.
    [[nodiscard]] std::ptrdiff_t stride() const {
        return 2 * kPadding + (columns_ + kPadding - 1) / kPadding * kPadding;
    }
    [[nodiscard]] std::size_t bytes() const { return cells_.size(); }

    /// Gives memory of the rows [first, end) back to the system, with their ghost cells. All their numbers must be 0,
    /// and stay so.
    void releaseRows(int first, int end) {
        const auto place = [this](int row) {
            return static_cast<std::size_t>(offset(row) - kPadding) * sizeof(std::int32_t);
        };
        cells_.release(place(first), place(end));
    }

private:
    // A row has three parts: a vector of padding, the cells rounded up to whole vectors, and another vector of padding.
    // The western ghost cell is the last cell of the first padding. The eastern ghost cell follows the last cell. It
    // lies in the second padding if the cells fill whole vectors.
    static constexpr int kPadding = 16;  // [cell], one cache line

    static const std::int32_t* numbers(const std::byte* bytes) { return reinterpret_cast<const std::int32_t*>(bytes); }
    static std::int32_t* numbers(std::byte* bytes) { return reinterpret_cast<std::int32_t*>(bytes); }
    [[nodiscard]] std::ptrdiff_t offset(int row) const { return (row + std::ptrdiff_t{1}) * stride() + kPadding; }

    int columns_;
    int rows_;
    base::ZeroedMemory cells_;
};

}  // namespace sand
