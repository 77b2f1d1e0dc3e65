// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/path_builder.hpp"

#include <gtest/gtest.h>

namespace {

using haptic_bridge::HandSample;
using haptic_bridge::PathBuilder;

constexpr int kStepsPerSecond = 60;

HandSample at(std::int32_t x, bool engaged = true) { return {x + 1, {x, 0, 0}, engaged}; }

sand::Step take(PathBuilder& builder, const haptic_bridge::SubstepLimit& limit = {}) {
    sand::Step step;
    (void)builder.take(step, limit);
    return step;
}

TEST(PathBuilder, GivesEverySampleInOrder) {
    PathBuilder builder(kStepsPerSecond);
    for (int x = 1; x <= 17; ++x) {
        builder.add(at(x));
    }
    sand::Step step;
    EXPECT_EQ(builder.take(step), 18) << "the time of the last sample";
    EXPECT_TRUE(step.engaged);
    ASSERT_EQ(step.path.size(), 17U);
    EXPECT_EQ(step.path.front().x, 1);
    EXPECT_EQ(step.path.back().x, 17);
}

TEST(PathBuilder, KnowsWhetherTheSamplesThatWaitMoveTheTool) {
    PathBuilder builder(kStepsPerSecond);
    EXPECT_FALSE(builder.moves());
    builder.add(at(7, false));
    EXPECT_TRUE(builder.moves());
    (void)take(builder);
    for (int i = 0; i < 3; ++i) {
        builder.add(at(7, false));
    }
    EXPECT_FALSE(builder.moves()) << "it hovers at the same place";
    builder.add(at(8, false));
    builder.add(at(7, false));
    EXPECT_TRUE(builder.moves()) << "it was elsewhere meanwhile";
    (void)take(builder);
    builder.add(at(7));
    EXPECT_TRUE(builder.moves()) << "it presses where it hovered";
    (void)take(builder);
    builder.add(at(7));
    EXPECT_FALSE(builder.moves());
    HandSample turned = at(7);
    turned.heading = sand::Heading{};
    builder.add(turned);
    EXPECT_TRUE(builder.moves());
    (void)take(builder);
    builder.add(at(7, false));
    EXPECT_TRUE(builder.moves()) << "it lifts the tool";
}

TEST(PathBuilder, ForgetsTheSamplesOfARestAndCountsNone) {
    PathBuilder builder(kStepsPerSecond);
    builder.add(at(7));
    (void)take(builder);
    for (int i = 0; i < 10; ++i) {
        builder.add(at(7));
    }
    builder.forgetRest();
    EXPECT_FALSE(builder.waits());
    EXPECT_EQ(builder.dropped(), 0U);
    builder.add(at(9));
    const sand::Step step = take(builder);
    EXPECT_TRUE(step.engaged);
    ASSERT_EQ(step.path.size(), 1U);
    EXPECT_EQ(step.path[0].x, 9);
}

TEST(PathBuilder, EndsAPathBehindTheSubstepsThatFit) {
    PathBuilder builder(kStepsPerSecond);
    for (int cell = 1; cell <= 9; ++cell) {
        builder.add(at(cell * sand::kProbePerCell));
    }
    sand::Step step;
    EXPECT_EQ(builder.take(step, {.wanted = 3}), 3 * sand::kProbePerCell + 1);
    EXPECT_EQ(step.path.size(), 3U) << "a press, and two cells";
    EXPECT_EQ(builder.engagedSinceNs(), 4 * sand::kProbePerCell + 1);
    (void)builder.take(step, {.wanted = 2});
    EXPECT_EQ(step.path.size(), 2U);
    EXPECT_EQ(step.path.front().x, 4 * sand::kProbePerCell);
    builder.add(at(40 * sand::kProbePerCell));
    (void)builder.take(step, {.wanted = 4});
    (void)builder.take(step, {.wanted = 1});
    EXPECT_EQ(step.path.size(), 1U) << "a single point is always taken";
    EXPECT_EQ(step.path.front().x, 40 * sand::kProbePerCell);
    EXPECT_EQ(builder.dropped(), 0U);
    EXPECT_EQ(builder.engagedSinceNs(), std::nullopt);
}

// A replica leaves out a longer path. So the tool would pass through the sand.
TEST(PathBuilder, DividesTheWayOfAJumpThatNoStepMayHave) {
    PathBuilder builder(kStepsPerSecond);
    builder.add(at(0));
    builder.add({2, {10 * sand::kProbePerCell - 1, -20 * sand::kProbePerCell, 30 * sand::kProbePerCell}, true});
    sand::Step step;
    (void)builder.take(step, {.wanted = 1, .most = 8});
    EXPECT_EQ(step.path, (std::vector<sand::ProbePoint>{{0, 0, 0}})) << "a press";
    sand::ProbePoint tool = step.path.back();
    int steps = 0;
    for (; builder.waits(); ++steps) {
        const std::int64_t readNs = builder.take(step, {.wanted = 1, .most = 8});
        EXPECT_EQ(readNs, builder.waits() ? 0 : 2) << "no hand was read on the way";
        EXPECT_TRUE(step.engaged);
        ASSERT_EQ(step.path.size(), 1U);
        EXPECT_LE(sand::substepsOf(step, tool, true, sand::kProbePerCell), 8);
        tool = step.path.back();
        // It stays on the line, to the cut-off fraction of each coordinate.
        EXPECT_NEAR(tool.x, tool.z / 3.0, 4);
        EXPECT_NEAR(tool.y, tool.z / -1.5, 4);
    }
    EXPECT_EQ(steps, 4) << "30 sub-steps";
    EXPECT_EQ(tool,
              (sand::ProbePoint{10 * sand::kProbePerCell - 1, -20 * sand::kProbePerCell, 30 * sand::kProbePerCell}));
}

TEST(PathBuilder, EndsAPathBehindTheSubstepsThatAStepMayHave) {
    PathBuilder builder(kStepsPerSecond);
    for (int cell = 1; cell <= 9; ++cell) {
        builder.add(at(cell * sand::kProbePerCell));
    }
    sand::Step step;
    (void)builder.take(step, {.most = 4});
    EXPECT_EQ(step.path.size(), 4U);
    EXPECT_EQ(step.path.back().x, 4 * sand::kProbePerCell);
    (void)builder.take(step, {.most = 4});
    EXPECT_EQ(step.path.back().x, 8 * sand::kProbePerCell);
}

TEST(PathBuilder, HoveringTakesNoTimeOfTheSand) {
    PathBuilder builder(kStepsPerSecond);
    for (int cell = 1; cell <= 9; ++cell) {
        builder.add(at(cell * sand::kProbePerCell, false));
    }
    sand::Step step;
    EXPECT_EQ(builder.engagedSinceNs(), std::nullopt);
    (void)builder.take(step, {.wanted = 1});
    EXPECT_EQ(step.path.size(), 9U);
}

TEST(PathBuilder, EndsAStepWhereTheHandLifts) {
    PathBuilder builder(kStepsPerSecond);
    for (int x = 1; x <= 9; ++x) {
        builder.add(at(x, x <= 3 || x >= 7));
    }
    const sand::Step first = take(builder), second = take(builder), third = take(builder);
    EXPECT_EQ(first.path.size(), 3U);
    EXPECT_TRUE(first.engaged);
    EXPECT_EQ(second.path.size(), 3U);
    EXPECT_FALSE(second.engaged);
    EXPECT_EQ(third.path.front().x, 7);
    EXPECT_TRUE(third.engaged);
}

TEST(PathBuilder, LeavesOutWhereTheHandRestsButNotWherePressed) {
    PathBuilder builder(kStepsPerSecond);
    builder.restart({5, 0, 0});
    builder.add(at(5, false));
    EXPECT_TRUE(take(builder).path.empty());
    builder.add(at(5, true));
    builder.add(at(5, true));
    const sand::Step pressed = take(builder);
    EXPECT_TRUE(pressed.engaged);
    EXPECT_EQ(pressed.path.size(), 1U) << "the path has the point of the press";
    const sand::Step held = take(builder);
    EXPECT_TRUE(held.engaged) << "without a sample the step is engaged as before";
    EXPECT_TRUE(held.path.empty());
}

TEST(PathBuilder, GivesTheLastHeadingOfItsSamples) {
    PathBuilder builder(kStepsPerSecond);
    const auto east = sand::headingOf(0), north = sand::headingOf(90);
    builder.add({1, {1, 0, 0}, true, east});
    builder.add({2, {2, 0, 0}, true, north});
    builder.add({3, {3, 0, 0}, true});
    builder.add({4, {4, 0, 0}, false, east});
    sand::Step step, lifted, resting;
    builder.take(step);
    EXPECT_EQ(step.heading, north);
    builder.take(lifted);
    EXPECT_EQ(lifted.heading, east) << "the heading of the samples after the lift";
    builder.take(resting);
    EXPECT_FALSE(resting.heading.has_value());
}

TEST(PathBuilder, ThinsALongPathEvenly) {
    PathBuilder builder(kStepsPerSecond);
    for (int x = 1; x <= 1000; ++x) {
        builder.add(at(x));
    }
    const sand::Step step = take(builder);
    ASSERT_EQ(step.path.size(), sand::kMaxPathPoints);
    EXPECT_EQ(step.path.front().x, 1);
    EXPECT_EQ(step.path.back().x, 1000);
    for (std::size_t i = 1; i < step.path.size(); ++i) {
        EXPECT_NEAR(step.path[i].x - step.path[i - 1].x, 999.0 / 63, 1.0);
    }
    EXPECT_EQ(builder.dropped(), 1000 - sand::kMaxPathPoints);
}

/// A hand that moves one probe unit per millisecond, in the sand.
void digFor(PathBuilder& builder, int milliseconds) {
    for (int x = 1; x <= milliseconds; ++x) {
        builder.add({x * 1'000'000LL, {x, 0, 0}, true});
    }
}

TEST(PathBuilder, CatchesUpByStepsOfFourPeriods) {
    PathBuilder builder(kStepsPerSecond);
    digFor(builder, 1000);
    std::int32_t last = 0;
    int steps = 0;
    for (sand::Step step = take(builder); !step.path.empty(); step = take(builder)) {
        EXPECT_TRUE(step.engaged);
        EXPECT_EQ(step.path.front().x, last + 1) << "no movement of the hand is lost";
        EXPECT_LE(step.path.back().x - last, 67) << "[ms]";
        last = step.path.back().x;
        ++steps;
    }
    EXPECT_EQ(last, 1000);
    EXPECT_EQ(steps, 15);
}

TEST(PathBuilder, AStepTakesAllOfAHandThatHovers) {
    PathBuilder builder(kStepsPerSecond);
    for (int x = 1; x <= 3000; ++x) {
        builder.add({x * 1'000'000LL, {x, 0, 0}, x > 2000 && x <= 2050});
    }
    const sand::Step hovering = take(builder), pressed = take(builder), lifted = take(builder);
    EXPECT_FALSE(hovering.engaged);
    EXPECT_EQ(hovering.path.size(), sand::kMaxPathPoints);
    EXPECT_EQ(hovering.path.back().x, 2000);
    EXPECT_TRUE(pressed.engaged);
    EXPECT_EQ(pressed.path.front().x, 2001);
    EXPECT_EQ(pressed.path.back().x, 2050);
    EXPECT_FALSE(lifted.engaged);
    EXPECT_EQ(lifted.path.back().x, 3000) << "at once, although it is a second late";
    EXPECT_EQ(builder.dropped(), 0U) << "points at which the tool hovers change no sand";
}

TEST(PathBuilder, EngagedSamplesWaitWhileAStepMayOnlyHover) {
    PathBuilder builder(kStepsPerSecond);
    builder.add(at(5, false));
    builder.add(at(6));
    const sand::Step hovering = take(builder, {.onlyHovering = true});
    EXPECT_FALSE(hovering.engaged);
    EXPECT_EQ(hovering.path.back().x, 5);
    for (int i = 0; i < 3; ++i) {
        const sand::Step waiting = take(builder, {.onlyHovering = true});
        EXPECT_FALSE(waiting.engaged);
        EXPECT_TRUE(waiting.path.empty());
    }
    const sand::Step pressed = take(builder);
    EXPECT_TRUE(pressed.engaged);
    EXPECT_EQ(pressed.path.back().x, 6);
}

TEST(PathBuilder, LetsGoOfAHandThatIsFarAhead) {
    PathBuilder builder(kStepsPerSecond);
    digFor(builder, 10);
    EXPECT_TRUE(take(builder).engaged);
    digFor(builder, 1500);
    const sand::Step lifted = take(builder), down = take(builder);
    EXPECT_FALSE(lifted.engaged);
    ASSERT_EQ(lifted.path.size(), 1U);
    EXPECT_TRUE(down.engaged);
    EXPECT_EQ(down.path.front(), lifted.path.front()) << "the tool presses where it was put down";
    EXPECT_GT(down.path.front().x, 1500 - 67);
    EXPECT_EQ(down.path.back().x, 1500);
    EXPECT_GE(builder.dropped(), 1400U);
    EXPECT_TRUE(take(builder).path.empty());
}

TEST(PathBuilder, StaysBoundedWhileNobodyTakes) {
    PathBuilder builder(kStepsPerSecond);
    for (int x = 1; x <= 100'000; ++x) {
        builder.add(at(x));
    }
    const sand::Step step = take(builder);
    EXPECT_EQ(step.path.size(), sand::kMaxPathPoints);
    EXPECT_EQ(step.path.back().x, 100'000) << "the hand must end where it is";
    EXPECT_EQ(builder.dropped(), 100'000 - sand::kMaxPathPoints);
    for (int x = 1; x <= 100'000; ++x) {
        builder.add(at(x, x % 2 == 0));
    }
    EXPECT_GT(builder.dropped(), 100'000U) << "the samples of a tapping hand are also bounded";
}

}  // namespace
