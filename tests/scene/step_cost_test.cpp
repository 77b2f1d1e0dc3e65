// SPDX-License-Identifier: Apache-2.0
#include "scene/load/step_cost.hpp"

#include <gtest/gtest.h>

#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::kProbePerCell;
using sand::ProbePoint;

TEST(StepCost, IsMeasuredWithAToolThatStaysInTheMiddleOfTheField) {
    scene::Scene scene = samples::flatScene(48, 30);
    for (int step = 0; step < 100; ++step) {
        const int east = 16 - std::abs(step % 32 - 16);  // [cell]: 0 1 2 … 15 16 15 … 1 0 1 …
        EXPECT_EQ(scene::digPlace(scene.rules, step, 100),
                  (ProbePoint{(24 + east) * kProbePerCell, 15 * kProbePerCell, 100 + 2 * kProbePerCell}))
            << step;
    }
}

// A step takes no longer than all the steps that were measured.
TEST(StepCost, IsThatOfAStep) {
    scene::Scene scene = samples::flatScene(48, 30);
    scene.rules.tuning.sweepsPerStep = 1;
    const auto cost = scene::stepCostOf(scene);
    ASSERT_TRUE(cost.has_value());
    EXPECT_EQ(cost->columns, 48);
    EXPECT_EQ(cost->rows, 30);
    EXPECT_GT(cost->seconds, 0);
    EXPECT_LE(cost->seconds, cost->measured);
    scene.rules.tuning.tool.radius = 0;
    EXPECT_FALSE(scene::stepCostOf(scene).has_value()) << "no tool digs";
}

}  // namespace
