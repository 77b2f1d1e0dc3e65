// SPDX-License-Identifier: Apache-2.0
#include "scene/load/step_cost.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/sand/high_sand.hpp"
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

TEST(StepCost, OfAToolThatHoldsFramesIsMeasuredBeforeTheStart) {
    scene::Scene scene = samples::flatScene(2000, 2000, 100);
    scene.rules.tuning.sweepsPerStep = 1667;
    ASSERT_TRUE(scene.rules.sweepPlan().hasCoarsePhase());
    EXPECT_FALSE(scene::costOfALargeTool(scene).has_value()) << "it is too small to hold a frame";
    scene.rules.tuning.tool.radius *= 9;
    EXPECT_TRUE(scene::costOfALargeTool(scene).has_value());
    scene.rules.tuning.sweepsPerStep = 8;
    ASSERT_FALSE(scene.rules.sweepPlan().hasCoarsePhase());
    EXPECT_FALSE(scene::costOfALargeTool(scene).has_value()) << "all of its work is spread over steps";
}

TEST(StepCost, SaysForHowLongAStepHoldsAFrame) {
    EXPECT_EQ(scene::StepCost{.seconds = 0.25}.longFrameText("s.toml"), "");
    EXPECT_EQ(scene::StepCost{.seconds = 1.71}.longFrameText("s.toml"),
              "s.toml: a step in which this tool digs takes ≈ 1.7 s on this machine, and holds a frame for as long; "
              "sandwall-check --scene s.toml prints up to which radius a step takes at most 250 ms");
}

// The radius doubles and the time is 16 times as long, so that the time grows with the fourth power between them.
TEST(LargestTools, AreInterpolatedBetweenMeasuredRadii) {
    const std::vector<std::pair<double, double>> measured{{8, 0.001}, {16, 0.016}, {32, 0.256}};
    EXPECT_EQ(scene::radiusAt(0.0005, measured), 0) << "not even the smallest one";
    EXPECT_NEAR(scene::radiusAt(0.001, measured), 8, 1e-12);
    EXPECT_NEAR(scene::radiusAt(0.002, measured), 8 * std::pow(2, 0.25), 1e-9);
    EXPECT_NEAR(scene::radiusAt(0.016, measured), 16, 1e-9);
    EXPECT_NEAR(scene::radiusAt(0.064, measured), 16 * std::sqrt(2), 1e-9);
    EXPECT_EQ(scene::radiusAt(1, measured), 32) << "the largest one, which is fast enough";
    const std::vector<std::pair<double, double>> alike{{4, 0.001}, {8, 0.001}, {16, 0.01}};
    EXPECT_NEAR(scene::radiusAt(0.001, alike), 8, 1e-12);
    EXPECT_EQ(scene::slowerBelow(0.002, measured), 0);
}

TEST(LargestTools, AreFoundAboveASlowerOne) {
    const std::vector<std::pair<double, double>> measured{{8, 0.004}, {16, 0.016}, {32, 0.002}, {64, 0.032}};
    EXPECT_NEAR(scene::radiusAt(0.008, measured), 32 * std::sqrt(2), 1e-9);
    EXPECT_EQ(scene::slowerBelow(0.008, measured), 16);
    EXPECT_EQ(scene::slowerBelow(0.016, measured), 0);
    EXPECT_EQ(scene::radiusAt(0.001, measured), 0);
    EXPECT_EQ(scene::slowerBelow(0.001, measured), 0);
    // Of 62.5 ms, half is for the step.
    const std::vector<std::pair<double, double>> rising{{16, 0.016}, {32, 0.03125}, {64, 0.0625}, {128, 0.5}};
    const scene::LargestTools tools = scene::largestOf(rising, 16);
    EXPECT_NEAR(tools.following, 32, 1e-9);
    EXPECT_NEAR(tools.fitting, 64 * std::pow(4, 1.0 / 3), 1e-9);
    EXPECT_EQ(tools.slower, 0);
    EXPECT_EQ(tools.tried, 128);
    EXPECT_EQ(scene::largestOf(measured, 62).slower, 16);
}

// A tool that follows the hand is never larger than one whose step only fits a long frame.
TEST(LargestTools, AreMeasuredWithTheToolOfTheScene) {
    scene::Scene scene = samples::flatScene(256, 256);
    scene.rules.stepsPerSecond = 2;  // a step may take as long as a long frame
    const auto slow = scene::largestToolsOf(scene);
    ASSERT_TRUE(slow.has_value());
    EXPECT_EQ(slow->following, slow->fitting);
    EXPECT_GE(slow->tried, 4);
    EXPECT_LE(slow->tried, 128);
    EXPECT_LE(slow->fitting, slow->tried);
    scene.rules.stepsPerSecond = 1'000'000;
    const auto fast = scene::largestToolsOf(scene);
    ASSERT_TRUE(fast.has_value());
    EXPECT_EQ(fast->following, 0) << "no tool digs in half a microsecond";
    EXPECT_GT(fast->fitting, 0);
    scene.rules.tuning.tool.radius = 0;
    EXPECT_FALSE(scene::largestToolsOf(scene).has_value()) << "no tool digs";
}

// A refused press moves little sand, so its step says nothing about others.
TEST(LargestTools, EndBeforeTheFirstPressThatDoesNotFit) {
    scene::Scene scene = samples::highScene(4);
    scene.material.settlingSeconds = 1000;  // four sweeps a step
    const auto tools = scene::largestToolsOf(scene);
    ASSERT_TRUE(tools.has_value());
    EXPECT_LT(tools->tried, samples::kHighSide / 4) << "the sand is a few cells below the largest height";
}

TEST(LargestTools, AreSaidInUnitsOfTheSceneAndInCells) {
    scene::Scene scene = samples::flatScene(256, 256);
    const std::string cell = fmt::format("{:.2g}", 10 * scene.terrain.cellSize());
    EXPECT_EQ((scene::LargestTools{.following = 10, .fitting = 64, .tried = 64}).text(scene),
              "this tool follows the hand up to a radius of ≈ " + cell +
                  " (10 cells); its step takes at most 250 ms up to a radius of ≈ " +
                  fmt::format("{:.2g}", 64 * scene.terrain.cellSize()) + " (64 cells, the largest that was tried)");
    EXPECT_TRUE((scene::LargestTools{.following = 0, .fitting = 8, .tried = 16})
                    .text(scene)
                    .starts_with("this tool follows the hand at no radius of 4 cells or more; "));
    EXPECT_NE((scene::LargestTools{.following = 64, .fitting = 64, .slower = 16, .tried = 64})
                  .text(scene)
                  .find("), but not at 16 cells; its step"),
              std::string::npos);
    scene.rules.tin = 1;
    const std::string held = ", and a larger one holds frames, because steps of a TIN are not spread";
    EXPECT_TRUE((scene::LargestTools{.following = 4, .fitting = 8, .tried = 16}).text(scene).ends_with(held));
    EXPECT_FALSE((scene::LargestTools{.following = 4, .fitting = 16, .tried = 16}).text(scene).ends_with(held))
        << "no larger one was measured";
}

}  // namespace
