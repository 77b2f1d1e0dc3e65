// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/grid/displacement.hpp"
#include "sand/model/ground.hpp"

namespace sand::grid {

/// What holds the sand of one patch: a tool above it, the rock and the walls around it. Copies of a few numbers per
/// cell, made for a patch that needs them and for the length of one sweep. All of them cover the patch's cells grown by
/// one on every side, row by row.
class FluxLimits {
public:
    std::vector<std::int32_t> heights;  // [unit], walls raised above everything; only with a ground
    std::vector<std::int32_t> sand;     // [unit]; only with a ground
    std::vector<std::int32_t> room;     // [unit] a cell may receive through one face

    FluxLimits(const HeightField& field, const CellRect& cells, const Ground* ground, const Obstacle* obstacle);

private:
    [[nodiscard]] std::size_t index(int column, int row) const;
    void copyField(const HeightField& field, const Ground& ground);
    void extendBeyondRim(const HeightField& field, const Ground& ground);
    void keepBelow(const HeightField& field, const Obstacle& obstacle);

    CellRect grown_;
};

}  // namespace sand::grid
