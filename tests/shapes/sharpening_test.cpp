// SPDX-License-Identifier: Apache-2.0
#include "shapes/model/sharpening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/seed.hpp"

namespace {

using sand::Movement;
using shapes::Sharpening;

Movement atRest(std::size_t tiles) { return {.step = 100, .newest = 0, .moved = std::vector<std::uint64_t>(tiles, 0)}; }

std::vector<std::uint8_t> marksOf(const Sharpening& rule, const Movement& movement) {
    std::vector<std::uint8_t> marks;
    rule.mark(movement, marks);
    return marks;
}

TEST(Sharpening, SandThatHasNeverMovedIsSharp) {
    const Sharpening rule(60, 9);
    EXPECT_TRUE(rule.allSharp(atRest(9)));
    EXPECT_EQ(marksOf(rule, atRest(9)), std::vector<std::uint8_t>(9, 0));
}

TEST(Sharpening, ATileCountsAsMovingForHalfASecondOfSteps) {
    for (const auto& [stepsPerSecond, steps] : {std::pair{60, 30U}, {1000, 500U}, {7, 4U}, {3, 2U}, {1, 2U}}) {
        const Sharpening rule(stepsPerSecond, 9);
        Movement movement = atRest(9);
        movement.add(4);
        const std::uint64_t moved = movement.step;
        for (; movement.step < moved + steps; ++movement.step) {
            ASSERT_EQ(marksOf(rule, movement), (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0}));
            ASSERT_FALSE(rule.allSharp(movement));
        }
        EXPECT_EQ(marksOf(rule, movement), std::vector<std::uint8_t>(9, 0)) << stepsPerSecond << " steps a second";
        EXPECT_TRUE(rule.allSharp(movement));
    }
}

// A field of 4096 x 4096 cells has 16384 tiles.
TEST(Sharpening, AFieldThatComesToRestAsAWholeIsSharpenedRowByRowWithinASecond) {
    for (const int stepsPerSecond : {1, 3, 60, 1000}) {
        constexpr std::size_t kTiles = 16384;
        const Sharpening rule(stepsPerSecond, kTiles);
        Movement movement = atRest(kTiles);
        for (std::size_t tile = 0; tile < kTiles; ++tile) {
            movement.add(static_cast<int>(tile));
        }
        std::size_t sharp = 0;
        const std::uint64_t moved = movement.step;
        while (sharp < kTiles) {
            ++movement.step;
            const std::vector<std::uint8_t> marks = marksOf(rule, movement);
            const auto first = std::ranges::find(marks, 1);
            ASSERT_EQ(std::count(first, marks.end(), 1), marks.end() - first) << "sharpened row by row";
            const auto before = sharp;
            sharp = static_cast<std::size_t>(first - marks.begin());
            ASSERT_LE(sharp - before, rule.tilesPerStep());
            ASSERT_EQ(rule.allSharp(movement), sharp == kTiles);
        }
        EXPECT_EQ(movement.step, moved + rule.longest());
        const double seconds = static_cast<double>(movement.step - moved) / stepsPerSecond;
        EXPECT_LE(seconds, 3) << stepsPerSecond << " steps a second";
    }
}

TEST(Sharpening, FewTilesAreSharpenedAtOnce) {
    const Sharpening rule(60, 256);
    Movement movement = atRest(256);
    for (int tile = 100; tile < 116; ++tile) {
        movement.add(tile);
    }
    movement.step += 29;
    EXPECT_EQ(std::ranges::count(marksOf(rule, movement), 1), 16);
    ++movement.step;
    EXPECT_EQ(std::ranges::count(marksOf(rule, movement), 1), 0);
}

TEST(Sharpening, ATileIsSharpUntilItMovesAgain) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    constexpr std::size_t kTiles = 900;
    const Sharpening rule(20, kTiles);  // a tile counts as moving for 10 steps, and a step sharpens 45 tiles
    Movement movement = atRest(kTiles);
    std::vector<std::uint8_t> before(kTiles, 0);
    std::size_t waited = 0;
    for (int i = 0; i < 600; ++i) {
        ++movement.step;
        const bool busy = i / 60 % 2 == 0;
        for (std::size_t tile = 0; busy && tile < kTiles; ++tile) {
            if (random() % 12 == 0) {
                movement.add(static_cast<int>(tile));
            }
        }
        const std::vector<std::uint8_t> marks = marksOf(rule, movement);
        for (std::size_t tile = 0; tile < kTiles; ++tile) {
            const std::uint64_t age = movement.step - movement.moved[tile];
            const bool everMoved = movement.moved[tile] != 0;
            ASSERT_TRUE(marks[tile] == 1 || !everMoved || age >= 10);
            ASSERT_TRUE(marks[tile] == 0 || (everMoved && age < rule.longest()));
            ASSERT_TRUE(before[tile] == 1 || marks[tile] == 0 || age == 0) << "tile " << tile << ", step " << i;
            waited += marks[tile] == 1 && age >= 10 ? 1 : 0;
        }
        before = marks;
    }
    EXPECT_GT(waited, 100U);
    EXPECT_EQ(std::ranges::count(before, 1), 0);
}

}  // namespace
