// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/grid/displacement.hpp"
#include "sand/model/ground.hpp"

namespace sand::grid {

/// Limits of the fluxes of one patch: the tool above it, rock and walls. They are copies of a few numbers per cell,
/// made for one sweep and only for a patch that needs them. Each array covers the patch's cells and one more on every
/// side, row by row.
class FluxLimits {
public:
    std::vector<std::int32_t> heights;  // [unit], with walls raised above everything; only with a ground
    std::vector<std::int32_t> sand;     // thickness of the sand [unit]; only with a ground
    std::vector<std::int32_t> room;     // most that a cell may receive through one face [unit]

    FluxLimits(const HeightField& field, const CellRect& cells, const Ground* ground, const Obstacle* obstacle);

private:
    [[nodiscard]] std::size_t index(int column, int row) const;
    void copyField(const HeightField& field, const Ground& ground);
    void extendBeyondRim(const HeightField& field, const Ground& ground);
    void keepBelow(const HeightField& field, const Obstacle& obstacle);

    CellRect grown_;
};

}  // namespace sand::grid
