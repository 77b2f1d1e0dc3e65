// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace sand::grid {

/// Total flux through every face of a grid during a relaxation. The end is the start minus the divergence of these
/// fluxes.
///
/// Fluxes are positive towards east and north [unit · cell]. Fluxes through the rim are outflow. Not thread-safe.
class NetFlux {
public:
    NetFlux(int columns, int rows)
        : columns_(columns),
          rows_(rows),
          east_((static_cast<std::size_t>(columns) + 1) * static_cast<std::size_t>(rows)),
          north_(static_cast<std::size_t>(columns) * (static_cast<std::size_t>(rows) + 1)) {}

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }

    /// Returns the fluxes through the eastern faces of a row's cells. Index -1 is the western rim.
    [[nodiscard]] std::int64_t* east(int row) { return east_.data() + (columns_ + std::ptrdiff_t{1}) * row + 1; }
    [[nodiscard]] const std::int64_t* east(int row) const {
        return east_.data() + (columns_ + std::ptrdiff_t{1}) * row + 1;
    }
    /// Returns the fluxes through the northern faces of a row's cells. Row -1 is the southern rim.
    [[nodiscard]] std::int64_t* north(int row) { return north_.data() + columns_ * (row + std::ptrdiff_t{1}); }
    [[nodiscard]] const std::int64_t* north(int row) const {
        return north_.data() + columns_ * (row + std::ptrdiff_t{1});
    }

    /// Returns how much the fluxes raised a cell [unit].
    [[nodiscard]] std::int64_t rise(int column, int row) const {
        return east(row)[column - 1] - east(row)[column] + north(row - 1)[column] - north(row)[column];
    }

    /// Adds the fluxes of another relaxation of a field of the same size.
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
