// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/tool_keys.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sand/sand_samples.hpp"

namespace {

using haptic_bridge::ToolLimits;

TEST(ToolKeys, LetTheToolBeFromTwoCellsToAQuarterOfTheField) {
    const scene::Scene scene = samples::flatScene(320, 80);
    const double cell = scene.terrain.cellSize();
    const ToolLimits limits = ToolLimits::of(scene);
    double radius = 10 * cell;
    for (int i = 0; i < 100; ++i) {
        radius = limits.resized(radius, -1);
    }
    EXPECT_DOUBLE_EQ(2 * radius, 2 * cell);
    for (int i = 0; i < 100; ++i) {
        radius = limits.resized(radius, 1);
    }
    EXPECT_DOUBLE_EQ(2 * radius, 20 * cell) << "a quarter of the shorter side";
}

TEST(ToolKeys, BringAToolOfASceneThatIsOutsideToTheLimit) {
    const ToolLimits limits{1, 8};
    EXPECT_EQ(limits.resized(20, 1), 20) << "no larger";
    EXPECT_EQ(limits.resized(20, -1), 8);
    EXPECT_EQ(limits.resized(0.01, -1), 0.01) << "no smaller";
    EXPECT_EQ(limits.resized(0.01, 1), 1) << "the first press, and not the twenty-first";
    EXPECT_EQ(limits.resized(0.01, 0.1), 1);
    EXPECT_EQ(limits.resized(7.9, 1), 8);
    EXPECT_EQ(limits.resized(1.1, -1), 1);
    EXPECT_EQ(limits.resized(4, 0.5), 4 * std::sqrt(1.25)) << "a wheel may turn by a part of a notch";
}

TEST(ToolKeys, LargerAndSmallerCancelOut) {
    const ToolLimits limits{0.001, 1};
    EXPECT_DOUBLE_EQ(limits.resized(0.04, 1), 0.05);
    EXPECT_DOUBLE_EQ(limits.resized(limits.resized(0.04, 1), -1), 0.04);
}

// A field of 4 cells has no room for both limits.
TEST(ToolKeys, OfATinyFieldKeepTheSmallestTool) {
    const scene::Scene scene = samples::flatScene(4, 4);
    const ToolLimits limits = ToolLimits::of(scene);
    EXPECT_EQ(limits.least, limits.most);
    EXPECT_DOUBLE_EQ(limits.least, scene.terrain.cellSize());
}

TEST(ToolKeys, KeepTheDepthWhereTheToolDigs) {
    EXPECT_NEAR(haptic_bridge::deepened(0.5, 2), 0.7, 1e-12);
    EXPECT_EQ(haptic_bridge::deepened(0.5, -100), 0.1) << "at 0 the wheel has switched digging off";
    EXPECT_EQ(haptic_bridge::deepened(0.5, 1000), 2);
}

TEST(ToolKeys, TurnAroundTheWholeCircle) {
    EXPECT_EQ(haptic_bridge::turned(358, 5), 3);
    EXPECT_EQ(haptic_bridge::turned(3, -5), 358);
    EXPECT_EQ(haptic_bridge::turned(-90, 5), 275) << "a scene may count clockwise";
    EXPECT_EQ(haptic_bridge::turned(0, 0), 0);
}

TEST(ToolKeys, KeepHumidityWithinItsRangeAndRound) {
    double humidity = 0;
    for (int i = 0; i < 3; ++i) {
        humidity = haptic_bridge::moistened(humidity, haptic_bridge::kMoreHumidity);
    }
    EXPECT_EQ(humidity, 0.3) << "and not the sum of three tenths";
    EXPECT_EQ(haptic_bridge::moistened(0.95, 0.1), 1);
    EXPECT_EQ(haptic_bridge::moistened(0.05, -0.1), 0);
}

}  // namespace
