// SPDX-License-Identifier: Apache-2.0
#include "sand/start.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/sand/tin_scene.hpp"

namespace {

using sand::Ground;
using sand::Start;

/// Returns sand of 9 x 6 cells of 0.5 whose heights are all different, without ground.
Start heights() {
    Start start = samples::flatScene(9, 6);
    start.terrain = sand::HeightField(9, 6, 0.5);
    for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 9; ++column) {
            start.terrain.setHeight(column, row, 1000 * row + column);
        }
    }
    return start;
}

TEST(StartMiddle, HasTheCellsInTheMiddleWithTheirRockAndWalls) {
    Start start = heights();
    auto ground = std::make_shared<Ground>(9, 6);
    for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 9; ++column) {
            ground->setBedrock(column, row, -10 * row - column);
        }
    }
    ground->setWall(3, 2);
    ground->setBedrock(4, 3, Ground::kBottomless);
    start.ground = ground;
    const Start part = start.middle(4).value();
    EXPECT_EQ(part.rules.columns, 4);
    EXPECT_EQ(part.rules.rows, 4);
    EXPECT_EQ(part.terrain.columns(), 4);
    EXPECT_EQ(part.terrain.rows(), 4);
    EXPECT_EQ(part.terrain.cellSize(), 0.5);
    EXPECT_EQ(part.rules.tuning, start.rules.tuning);
    ASSERT_NE(part.ground, nullptr);
    // Of 9 columns, 2 are left out in the west and 3 in the east. Of 6 rows, one is left out on each side.
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            SCOPED_TRACE(testing::Message() << "column " << column << ", row " << row);
            EXPECT_EQ(part.terrain.height(column, row), 1000 * (row + 1) + column + 2);
            EXPECT_EQ(part.ground->isWall(column, row), column == 1 && row == 1);
            EXPECT_EQ(part.ground->bedrock(column, row), ground->bedrock(column + 2, row + 1));
        }
    }
}

TEST(StartMiddle, OfASmallFieldIsTheWholeField) {
    const Start start = heights();
    for (const int most : {9, 10, 512}) {
        const Start part = start.middle(most).value();
        EXPECT_EQ(part.terrain.columns(), 9);
        EXPECT_EQ(part.terrain.rows(), 6);
        EXPECT_EQ(part.terrain.height(0, 0), start.terrain.height(0, 0));
        EXPECT_EQ(part.terrain.height(8, 5), start.terrain.height(8, 5));
        EXPECT_EQ(part.ground, nullptr);
    }
    const Start strip = start.middle(7).value();
    EXPECT_EQ(strip.terrain.columns(), 7);
    EXPECT_EQ(strip.terrain.rows(), 6);
    EXPECT_EQ(strip.terrain.height(0, 0), start.terrain.height(1, 0));
}

TEST(StartMiddle, OfATinIsNotMade) { EXPECT_EQ(Start(samples::tinScene()).middle(512), std::nullopt); }

}  // namespace
