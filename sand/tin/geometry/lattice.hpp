// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// Cell centres at equal distances. A start that is made from a raster has vertices there, whatever its heights are.
struct Lattice {
    explicit constexpr Lattice(std::int32_t widest /* [probe unit] */) : every(widest / kLatticePerCell) {}

    std::int32_t every;  // distance [cell]; the first centre is half of it from the rim; 0: no vertices

    /// Returns the number of vertices on a field of `columns` × `rows` cells.
    [[nodiscard]] constexpr std::int64_t size(int columns, int rows) const {
        return every == 0 ? 0 : along(columns) * along(rows);
    }

private:
    [[nodiscard]] constexpr std::int64_t along(int cells) const {
        return cells <= every / 2 ? 0 : (cells - every / 2 - 1) / every + 1;
    }
};

}  // namespace sand::tin
