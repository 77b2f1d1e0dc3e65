// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/grid/displacement.hpp"
#include "sand/model/ground.hpp"

namespace sand::grid {

/// Limits of the fluxes of one patch of a field with ground: rock, walls, and the tool above it. They are copies of a
/// few numbers per cell, made for one sweep. Each array covers the patch's cells and one more on every side, row by
/// row. Cells beyond the rim have the numbers of the nearest cell of the field.
class FluxLimits {
public:
    std::vector<std::int32_t> heights;  // [unit], with walls raised above everything
    std::vector<std::int32_t> sand;     // thickness of the sand [unit]
    std::vector<std::int32_t> room;  // free height below the tool [unit]; 0 in a wall, Obstacle::kFree without a limit

    /// `obstacle` may be null.
    FluxLimits(const HeightField& field, const CellRect& cells, const Ground& ground, const Obstacle* obstacle);

private:
    [[nodiscard]] std::size_t index(int column, int row) const;
    void copyField(const HeightField& field, const Ground& ground);
    void extendBeyondRim(const HeightField& field);
    void keepBelow(const HeightField& field, const Obstacle& obstacle);

    CellRect grown_;
};

}  // namespace sand::grid
