// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sand/model/cell_array.hpp"

namespace sand::grid {

/// Copy of the numbers of a rectangle of cells, in as few bits as they need.
///
/// Making it takes about as long as copying the numbers. Heights of steep sand take about 17 bits each, fluxes fewer.
/// It never changes, so any thread may read it.
class PackedCells {
public:
    /// Copies the numbers of `cells`, which must not be empty and may include ghost cells. Row 0 of `grid` has row
    /// `first` of the field.
    PackedCells(const CellArray& grid, const CellRect& cells, int first = 0);

    [[nodiscard]] const CellRect& cells() const { return cells_; }
    /// Returns whether all numbers are 0.
    [[nodiscard]] bool isZero() const { return isZero_; }
    /// Returns the memory that it takes [byte].
    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(sizeof *this + groups_.capacity() * sizeof(Group) +
                                         words_.capacity() * sizeof(std::uint32_t));
    }
    /// Writes the numbers of rows [first, end) into `grid`, row `first` of them into its row `to`.
    void putInto(CellArray& grid, int first, int end, int to) const;
    void putInto(CellArray& grid) const { putInto(grid, cells_.y0, cells_.y1, cells_.y0); }
    /// Returns all numbers, row by row from the south-west.
    [[nodiscard]] std::vector<std::int32_t> numbers() const;
    /// Returns whether both have the same cells and numbers.
    friend bool operator==(const PackedCells&, const PackedCells&) = default;

private:
    // The cells of a row fill vectors of kLanes numbers; the last number is repeated. Vectors are packed in groups of
    // kGroup. A group has one number of bits. Lane i of its words has the bits of all numbers i of its vectors. A group
    // holds either the numbers or their differences to the row in the south. A difference in the first row is to the
    // cell in the west.
    static constexpr int kLanes = 16, kGroup = 32;
    struct Group {
        std::uint8_t bits = 0;  // of each number
        bool differences = false;
        std::size_t words = 0;  // place of its first word
        friend bool operator==(const Group&, const Group&) = default;
    };

    [[nodiscard]] std::size_t across() const;  // numbers in a row, with repeated ones
    [[nodiscard]] std::vector<std::int32_t> plainOf(const CellArray& grid, int first) const;
    [[nodiscard]] std::vector<std::int32_t> unpacked() const;

    CellRect cells_;
    std::int32_t first_ = 0;  // number of the south-western cell
    bool isZero_ = false;
    std::vector<Group> groups_;
    std::vector<std::uint32_t> words_;
};

}  // namespace sand::grid
