// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sand/model/cell_array.hpp"

namespace shapes {

/// Neighbouring triangles with consecutive indices, so that a part of a chunk can be drawn.
struct TriangleBlock {
    sand::CellRect quads;
    int first, count;  // [index]
};
/// Returns the blocks of level 0, of 8 × 8 quads each. A coarser level has few triangles and no blocks.
[[nodiscard]] std::vector<TriangleBlock> blocksOf(int quadsAcross, int quadsDown);

}  // namespace shapes
