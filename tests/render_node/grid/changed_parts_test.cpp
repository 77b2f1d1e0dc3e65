// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/changed_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/seed.hpp"

namespace {

using render_node::ChangedPart;
using shapes::GridVertices;

constexpr int kBlock = GridVertices::kBlock, kReach = 26;  // [cell]

/// Returns overwritten cells in `count` blocks of a field of `side` cells. Each rectangle is within its block.
std::vector<GridVertices::Overwritten> someIn(int side, int count, std::mt19937& random) {
    const auto below = [&random](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
    std::vector<GridVertices::Overwritten> result;
    for (int i = 0; i < count; ++i) {
        const int x = below(side / kBlock) * kBlock, y = below(side / kBlock) * kBlock;
        const int left = below(kBlock), low = below(kBlock);
        result.push_back(
            {{x + left, y + low, x + left + 1 + below(kBlock - left), y + low + 1 + below(kBlock - low)}, {}});
    }
    return result;
}

/// Calls visit(overwritten, random) for few and many blocks in small and large fields.
template <class Visit>
void forEachSample(const Visit& visit) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    for (const int side : {32, 256, 2048}) {
        for (const int count : {1, 3, 40, 900}) {
            visit(someIn(side, count, random), random);
        }
    }
}

TEST(ChangedParts, AreFewAndDisjointAndHoldAll) {
    forEachSample([](const std::vector<GridVertices::Overwritten>& overwritten, std::mt19937&) {
        const std::vector<ChangedPart> parts = render_node::changedParts(overwritten, kReach);
        ASSERT_GE(parts.size(), 1U);
        ASSERT_LE(parts.size(), static_cast<std::size_t>(render_node::kMostChangedParts));
        for (const auto& [cells, before] : overwritten) {
            const auto holds = [&rect = cells](const ChangedPart& part) {
                return part.cells.joinedWith(rect) == part.cells;
            };
            ASSERT_EQ(std::count_if(parts.begin(), parts.end(), holds), 1);
        }
        for (std::size_t i = 0; i < parts.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                ASSERT_TRUE(parts[i].cells.clippedTo(parts[j].cells).empty());
            }
        }
    });
}

// Two distant places must not become one rectangle, at any distance.
TEST(ChangedParts, KeepPlacesFarApart) {
    const std::vector<GridVertices::Overwritten> overwritten{{{3, 3, 5, 5}, {}}, {{2040, 2041, 2048, 2048}, {}}};
    const std::vector<ChangedPart> parts = render_node::changedParts(overwritten, kReach);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].cells, overwritten[0].cells);
    EXPECT_EQ(parts[1].cells, overwritten[1].cells);
}

// A triangle of a coarse level reaches from a part to cells that belong to another part.
TEST(ChangedParts, KnowTheHeightsBeforeInTheirReach) {
    forEachSample([](std::vector<GridVertices::Overwritten> overwritten, std::mt19937& random) {
        for (auto& [cells, before] : overwritten) {
            const auto low = static_cast<float>(random() % 1000U);
            before = {low, low + 1};
        }
        for (const ChangedPart& part : render_node::changedParts(overwritten, kReach)) {
            shapes::HeightRange expected{1e9F, -1e9F};
            for (const auto& [cells, before] : overwritten) {
                if (!part.cells.grownBy(kReach).clippedTo(cells).empty()) {
                    expected = shapes::around(expected, before);
                }
            }
            ASSERT_EQ(part.before.lowest, expected.lowest);
            ASSERT_EQ(part.before.highest, expected.highest);
        }
    });
}

}  // namespace
