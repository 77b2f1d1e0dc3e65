// SPDX-License-Identifier: Apache-2.0
#include "shapes/grid/triangle_blocks.hpp"

#include <algorithm>

namespace shapes {

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
