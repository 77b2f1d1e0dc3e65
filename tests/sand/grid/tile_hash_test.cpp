// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/tile_hash.hpp"

#include <gtest/gtest.h>

namespace grid_hash {
namespace {

using sand::grid::TileHash;

/// Returns whether the tiles of a field cover each of its cells once, and none of them is empty.
bool coversOnce(int columns, int rows) {
    const TileHash hash(sand::HeightField(columns, rows, 1));
    std::vector<int> covered(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    bool full = true;
    for (int tile = 0; tile < hash.tileCount(); ++tile) {
        const sand::CellRect cells = hash.cellsOf(tile);
        full = full && cells.x0 < cells.x1 && cells.y0 < cells.y1;
        for (int y = cells.y0; y < cells.y1; ++y) {
            for (int x = cells.x0; x < cells.x1; ++x) {
                ++covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(x)];
            }
        }
    }
    return full && covered == std::vector(covered.size(), 1);
}

// An empty tile would have a hash, too. The hash of a whole field would then be another one.
TEST(GridHash, HasTilesForEachCellAndNoMore) {
    for (const int columns : {1, 31, 32, 33, 63, 64, 65}) {
        for (const int rows : {1, 31, 32, 33, 63, 64, 65}) {
            EXPECT_TRUE(coversOnce(columns, rows)) << columns << " x " << rows;
        }
    }
}

}  // namespace
}  // namespace grid_hash
