// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sand/model/cell_array.hpp"
#include "shapes/model/levels.hpp"

namespace shapes {

/// Returns the coarsest level for a field: the longer side still has at least 128 cells at that level.
///
/// A change of the sand makes the largest triangle around it change. With one more level, a hand that digs in a field
/// of 512 cells would cost more than the level saves.
[[nodiscard]] int coarsestLevel(int columns, int rows);

/// Division of a field's vertex grid into chunks of equal size. Neighbours share the vertices on their edge. The last
/// chunks may extend beyond the grid, whose last column and row are repeated there.
struct ChunkLayout {
    ChunkLayout(int columns, int rows /* of the field */);

    int coarsest;                // level
    int across, down;            // number of chunks
    int quadsAcross, quadsDown;  // of every chunk

    /// Returns the vertices of a chunk.
    [[nodiscard]] sand::CellRect vertices(int x, int y) const {
        return {x * quadsAcross, y * quadsDown, (x + 1) * quadsAcross + 1, (y + 1) * quadsDown + 1};
    }
};

/// Neighbouring triangles with consecutive indices, so that a part of a chunk can be drawn.
struct TriangleBlock {
    sand::CellRect quads;
    int first, count;  // [index]
};
/// Returns the blocks of a chunk at level 0, of 8 × 8 quads each. A coarser level has few triangles and no blocks.
[[nodiscard]] std::vector<TriangleBlock> blocksOf(int quadsAcross, int quadsDown);

}  // namespace shapes
