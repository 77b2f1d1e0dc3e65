// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/block_marks.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace {

constexpr int kBlocksAcross = 13, kBlocksDown = 9;

TEST(BlockMarks, GiveEachOnceInOrderAndAreEmptyThen) {
    sand::grid::BlockMarks marks(kBlocksAcross, kBlocksDown);
    std::mt19937 random(3);
    for (int run = 0; run < 200; ++run) {
        EXPECT_TRUE(marks.empty());
        std::set<int> expected;
        for (auto adds = random() % 5; adds > 0; --adds) {
            const int x = static_cast<int>(random() % kBlocksAcross), y = static_cast<int>(random() % kBlocksDown);
            const sand::CellRect blocks =
                sand::CellRect{x - 1, y - 1, x + 2, y + 3}.clippedTo({0, 0, kBlocksAcross, kBlocksDown});
            marks.add(blocks);
            for (int v = blocks.y0; v < blocks.y1; ++v) {
                for (int u = blocks.x0; u < blocks.x1; ++u) {
                    expected.insert(v * kBlocksAcross + u);
                }
            }
        }
        EXPECT_EQ(marks.empty(), expected.empty());
        std::vector<int> taken;
        marks.takeAll([&](int block) { taken.push_back(block); });
        ASSERT_EQ(taken, std::vector<int>(expected.begin(), expected.end())) << "run " << run;
    }
}

}  // namespace
