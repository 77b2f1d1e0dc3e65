// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace sand::grid {

/// What went through every face of a grid while it relaxed, in total: the start minus its divergence is the end.
///
/// Fluxes are positive towards east and north, in [unit · cell]; those through the rim are what fell over it. Not
/// thread-safe.
class NetFlux {
public:
    NetFlux(int columns, int rows)
        : columns_(columns),
          rows_(rows),
          east_((static_cast<std::size_t>(columns) + 1) * static_cast<std::size_t>(rows)),
          north_(static_cast<std::size_t>(columns) * (static_cast<std::size_t>(rows) + 1)) {}

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }

    /// Through the eastern faces of a row's cells: index -1 is the western rim.
    [[nodiscard]] std::int64_t* east(int row) { return east_.data() + (columns_ + std::ptrdiff_t{1}) * row + 1; }
    [[nodiscard]] const std::int64_t* east(int row) const {
        return east_.data() + (columns_ + std::ptrdiff_t{1}) * row + 1;
    }
    /// Through the northern faces of a row's cells: row -1 is the southern rim.
    [[nodiscard]] std::int64_t* north(int row) { return north_.data() + columns_ * (row + std::ptrdiff_t{1}); }
    [[nodiscard]] const std::int64_t* north(int row) const {
        return north_.data() + columns_ * (row + std::ptrdiff_t{1});
    }

    /// By how much the fluxes raised a cell [unit].
    [[nodiscard]] std::int64_t rise(int column, int row) const {
        return east(row)[column - 1] - east(row)[column] + north(row - 1)[column] - north(row)[column];
    }

    /// Adds what passed in another relaxation of a field of the same size.
    void add(const NetFlux& other) {
        const auto addTo = [](std::vector<std::int64_t>& sums, const std::vector<std::int64_t>& more) {
            std::transform(sums.begin(), sums.end(), more.begin(), sums.begin(), std::plus<>());
        };
        addTo(east_, other.east_);
        addTo(north_, other.north_);
    }

private:
    int columns_, rows_;
    std::vector<std::int64_t> east_;
    std::vector<std::int64_t> north_;
};

}  // namespace sand::grid
