// SPDX-License-Identifier: Apache-2.0
#include "shapes/grid/chunk_layout.hpp"

#include <algorithm>

namespace shapes {
namespace {

constexpr int kKeptCells = 128;  // along the longer side, at the coarsest level
constexpr int kChunk = 16;       // [quad], shortest side of a chunk, except in small fields

// Levels need sides that are multiples of twice the largest stride. A field without levels gets chunks of equal size.
int shortestSide(int coarsest) { return std::max(kChunk, 2 << coarsest); }
int chunksFor(int quads, int coarsest) {
    const int side = shortestSide(coarsest);
    return coarsest > 0 ? (quads + side - 1) / side : std::max(1, quads / side);
}
int sideFor(int quads, int coarsest) {
    return coarsest > 0 ? shortestSide(coarsest) : (quads + chunksFor(quads, 0) - 1) / chunksFor(quads, 0);
}

}  // namespace

int coarsestLevel(int columns, int rows) {
    int level = 0;
    while (level + 1 < kLevels && (std::max(columns, rows) >> (level + 1)) >= kKeptCells) {
        ++level;
    }
    return level;
}

ChunkLayout::ChunkLayout(int columns, int rows)
    : coarsest(coarsestLevel(columns, rows)),
      across(chunksFor(columns + 1, coarsest)),
      down(chunksFor(rows + 1, coarsest)),
      quadsAcross(sideFor(columns + 1, coarsest)),
      quadsDown(sideFor(rows + 1, coarsest)) {}

std::vector<TriangleBlock> blocksOf(int quadsAcross, int quadsDown) {
    constexpr int kSide = 8;  // [quad]
    std::vector<TriangleBlock> blocks;
    int first = 0;
    for (int y = 0; y < quadsDown; y += kSide) {
        for (int x = 0; x < quadsAcross; x += kSide) {
            const sand::CellRect quads{x, y, std::min(x + kSide, quadsAcross), std::min(y + kSide, quadsDown)};
            const int count = 6 * (quads.x1 - quads.x0) * (quads.y1 - quads.y0);
            blocks.push_back({quads, first, count});
            first += count;
        }
    }
    return blocks;
}

}  // namespace shapes
