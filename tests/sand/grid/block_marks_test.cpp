// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/block_marks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

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

using sand::grid::FlowBits;
namespace flow = sand::grid::flow;

/// Returns whether a block must be visited because sand flowed in the block that is `east` columns and `north` rows
/// before it.
bool reaches(int bits, int east, int north) {
    const int alongRow = east == 0 ? flow::kSomewhere : east > 0 ? flow::kEast : flow::kWest;
    const int alongColumn = north == 0 ? flow::kSomewhere : north > 0 ? flow::kNorth : flow::kSouth;
    return (bits & alongRow) != 0 && (bits & alongColumn) != 0;
}

/// Sand flows at random places of a few runs of blocks. Returns these runs.
std::vector<sand::CellRect> randomFlow(std::mt19937& random, FlowBits& flowed) {
    std::vector<sand::CellRect> runs;
    for (int y = 0; y < kBlocksDown; ++y) {
        for (int x = static_cast<int>(random() % 6); x < kBlocksAcross; x += 1 + static_cast<int>(random() % 4)) {
            const int end = std::min(x + 1 + static_cast<int>(random() % 5), kBlocksAcross);
            runs.push_back({x, y, end, y + 1});
            for (; x < end; ++x) {
                flowed.row(y)[x] = static_cast<std::uint8_t>(random() % 2 == 0 ? 0 : flow::kSomewhere | random() % 32);
            }
        }
    }
    return runs;
}

TEST(BlockMarks, HoldTheBlocksBesideFlowAndThoseThatChanged) {
    std::mt19937 random(5);
    for (int run = 0; run < 200; ++run) {
        FlowBits flowed(kBlocksAcross, kBlocksDown);
        sand::grid::BlockMarks beside(kBlocksAcross, kBlocksDown), changed(kBlocksAcross, kBlocksDown);
        for (const sand::CellRect& blocks : randomFlow(random, flowed)) {
            beside.addBeside(blocks, flowed);
            changed.addChanged(blocks, flowed);
        }
        std::vector<int> expectedBeside, expectedChanged;
        for (int block = 0; block < kBlocksAcross * kBlocksDown; ++block) {
            const int x = block % kBlocksAcross, y = block / kBlocksAcross;
            bool isBeside = false, isChanged = false;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, kBlocksDown - 1); ++v) {
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, kBlocksAcross - 1); ++u) {
                    const int bits = flowed.row(v)[u];
                    isBeside = isBeside || reaches(bits, x - u, y - v);
                    isChanged = isChanged || (bits != 0 && x >= u && y >= v && (x == u || y == v));
                }
            }
            if (isBeside) {
                expectedBeside.push_back(block);
            }
            if (isChanged) {
                expectedChanged.push_back(block);
            }
        }
        std::vector<int> taken;
        beside.takeAll([&](int block) { taken.push_back(block); });
        ASSERT_EQ(taken, expectedBeside) << "run " << run;
        taken.clear();
        changed.takeAll([&](int block) { taken.push_back(block); });
        ASSERT_EQ(taken, expectedChanged) << "run " << run;
        EXPECT_TRUE(beside.empty() && changed.empty());
    }
}

}  // namespace
