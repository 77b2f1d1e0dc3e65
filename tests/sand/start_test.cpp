// SPDX-License-Identifier: Apache-2.0
#include "sand/start.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <variant>

#include "sand/replica.hpp"
#include "sand/surface_factory.hpp"
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

/// Returns a scene whose heights are all different.
scene::Scene hilly(int columns, int rows) {
    scene::Scene scene = samples::flatScene(columns, rows);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            scene.terrain.setHeight(column, row, 100'000 * row + column);
        }
    }
    return scene;
}

// Replicas and the encoded scene share the compressed heights.
TEST(StartPacked, ChangesNeitherBytesNorSand) {
    scene::Scene scene = hilly(70, 50);
    const base::Bytes plain = scene.encode();
    const sand::Replica before(scene);
    scene.pack();
    EXPECT_EQ(scene.encode(), plain);
    sand::Replica after(scene);
    sand::Step step{1, 1, false, {}};
    step.edit = sand::Edit(sand::Edit::reset);
    step.sweeps = after.wholeSweeps(step);
    after.apply(step);
    EXPECT_TRUE(sameHeights(std::get<sand::GridData>(after.surface().data()).field, scene.terrain));
    EXPECT_EQ(scene::Scene::decode(plain).packed, nullptr) << "its terrain may change";
    const scene::Scene decoded = scene::Scene::decode(plain, Start::Keep::packedToo);
    ASSERT_NE(decoded.packed, nullptr);
    EXPECT_EQ(*decoded.packed, *scene.packed);
    EXPECT_EQ(decoded.encode(), plain);
}

TEST(StartPacked, IsDroppedWithTheHeights) {
    scene::Scene scene = hilly(70, 50);
    scene.pack();
    sand::Replica sand(scene);
    const std::uint64_t hash = sand.stateHash();
    const double cell = scene.terrain.cellSize();
    const std::int32_t mean = scene.referenceHeight();
    scene.dropHeights();
    EXPECT_EQ(scene.packed, nullptr);
    EXPECT_EQ(scene.terrain.cellSize(), cell);
    EXPECT_EQ(scene.rules.columns, 70);
    EXPECT_EQ(scene.referenceHeight(), mean);
    EXPECT_EQ(scene.volumeOfHeights(), sand.volume());
    EXPECT_EQ(sand.stateHash(), hash);
    scene::Scene tin = samples::tinScene();
    const std::int32_t meanOfTin = tin.referenceHeight();
    tin.dropHeights();
    EXPECT_EQ(tin.referenceHeight(), meanOfTin) << "a TIN is kept";
}

// The heights of the surface at the start outlive those of the Start, unpacked or not.
TEST(StartHeights, StayWhenTheStartDropsItsHeights) {
    for (const bool packs : {false, true}) {
        for (const sand::Heights when : {sand::Heights::now, sand::Heights::atFirstUse}) {
            scene::Scene scene = hilly(70, 50);
            if (packs) {
                scene.pack();
            }
            const sand::HeightField before = scene.terrain;
            const sand::HeightAt heights = sand::startHeights(scene, when);
            scene.dropHeights();
            for (const double at : {5.5 * sand::kProbePerCell, 33.25 * sand::kProbePerCell}) {
                EXPECT_EQ(heights(at, at + 7), before.interpolated(at, at + 7)) << packs;
            }
        }
    }
}

}  // namespace
