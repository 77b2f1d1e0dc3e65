// SPDX-License-Identifier: Apache-2.0
#include "shapes/grid/chunk_layout.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Levels, OfASmallFieldAreNone) {
    EXPECT_EQ(shapes::coarsestLevel(128, 128), 0);
    EXPECT_EQ(shapes::coarsestLevel(255, 64), 0);
    EXPECT_EQ(shapes::coarsestLevel(256, 64), 1);
    EXPECT_EQ(shapes::coarsestLevel(512, 512), 2);
    EXPECT_EQ(shapes::coarsestLevel(16384, 16384), shapes::kLevels - 1);
}

TEST(ChunkLayout, CoversTheVertexGridWithNoChunkBeyondIt) {
    for (const int columns : {1, 15, 16, 160, 161, 255, 512, 1000}) {
        for (const int rows : {1, 17, 120, 2000}) {
            const shapes::ChunkLayout layout(columns, rows);
            const sand::CellRect last = layout.vertices(layout.across - 1, layout.down - 1);
            EXPECT_GE(last.x1, columns + 2) << columns << " x " << rows;
            EXPECT_GE(last.y1, rows + 2) << columns << " x " << rows;
            EXPECT_LT(last.x0, columns + 1) << columns << " x " << rows;
            EXPECT_LT(last.y0, rows + 1) << columns << " x " << rows;
        }
    }
}

}  // namespace
