// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// Middles of cells at equal distances, where a start made of a raster has vertices whatever its heights are.
struct Lattice {
    explicit constexpr Lattice(std::int32_t widest /* [probe unit] */) : every(widest / kLatticePerCell) {}

    std::int32_t every;  // [cell], the first at half of it; 0: none

    [[nodiscard]] constexpr std::int64_t size(int columns, int rows) const {
        return every == 0 ? 0 : along(columns) * along(rows);
    }

private:
    [[nodiscard]] constexpr std::int64_t along(int cells) const {
        return cells <= every / 2 ? 0 : (cells - every / 2 - 1) / every + 1;
    }
};

}  // namespace sand::tin
