// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/sweep_budget.hpp"

#include <gtest/gtest.h>

#include "haptic_bridge/hand/path_builder.hpp"
#include "tests/support/borders/border_scenes.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using haptic_bridge::Pace;
using haptic_bridge::SweepBudget;
using sand::Step;

constexpr std::int64_t kPeriod = 16'000'000, kMillisecond = 1'000'000;

class Budget : public testing::Test {
protected:
    Budget() {
        scene_ = samples::flatScene(1000, 500);  // a sweep takes at most 1 ms
        scene_.rules.tuning.sweepsPerStep = 4000;
        sand_.emplace(scene_);
    }
    /// Returns the sweeps of the next step, which engages, holds or edits.
    std::int32_t next(bool engaged = false, const sand::Edit& edit = {}) {
        return budget_.sweepsOf({1, sand_->stepNumber() + 1, engaged, {}, edit}, *sand_);
    }
    /// Shows a frame with a part of `sweeps` sweeps. Each sweep takes `sweepNs`.
    void show(std::int64_t sweeps, std::int64_t sweepNs, std::int64_t drawNs = 0) {
        budget_.shown({.sweeps = sweeps, .sweepNs = sweeps * sweepNs, .drawNs = drawNs}, sand_->stepNumber() + 1);
    }

    scene::Scene scene_;
    std::optional<sand::Replica> sand_;
    SweepBudget budget_{Pace::realtime, kPeriod};
};

TEST_F(Budget, IsHalfOfPeriodOrDrawingAndAtMostEightyMilliseconds) {
    EXPECT_EQ(budget_.budgetNs(), kPeriod / 2);
    show(1, 1, 10 * kMillisecond);
    EXPECT_EQ(budget_.budgetNs(), kPeriod / 2) << "drawing is shorter than the period";
    show(1, 1, 40 * kMillisecond);
    EXPECT_EQ(budget_.budgetNs(), 20 * kMillisecond);
    EXPECT_EQ(SweepBudget(Pace::realtime, 900 * kMillisecond).budgetNs(), 80 * kMillisecond);
}

TEST_F(Budget, LeavesAFrameOfAFifthOfASecondToDrawingThatIsLong) {
    for (const auto& [draw, budget] : {std::pair(120, 60), {150, 50}, {175, 25}, {190, 20}, {900, 20}}) {
        show(1, 1, draw * kMillisecond);
        EXPECT_EQ(budget_.budgetNs(), budget * kMillisecond) << draw;
    }
}

TEST_F(Budget, BeginsAsIfAllSandMovedAndAtMostDoublesWithEachFrameThatWasShown) {
    EXPECT_EQ(next(), 8);
    EXPECT_EQ(next(), 8) << "no cost is known yet";
    for (const int part : {16, 32, 64, 128, 256}) {
        show(part / 2, 1000);
        EXPECT_EQ(next(), part);
    }
    show(200, 1000);
    EXPECT_EQ(next(), 400);
    show(3, 1000);
    EXPECT_EQ(next(), 400) << "sand that rested early does not make parts small";
}

TEST_F(Budget, FitsByTheLastTimeOfASweep) {
    (void)next();
    show(1000, 10'000);
    EXPECT_EQ(next(), 800) << "8 ms of 0.01 ms each";
    show(800, 20'000);
    show(200, 20'000);
    EXPECT_EQ(next(), 400);
    show(400, 400 * kMillisecond);
    EXPECT_EQ(next(), 1) << "at least one";
    show(1, 10'000);
    EXPECT_EQ(next(), 800);
}

TEST_F(Budget, ALongPartIsShorterWhileSweepsTakeLongerAndLonger) {
    (void)next();
    show(1000, 10'000);
    show(800, 20'000);
    EXPECT_EQ(next(), 200) << "400 fit, and the next sweeps may take twice as long again";
    show(200, 30'000);
    EXPECT_EQ(next(), 177) << "8 ms of 0.03 ms each, divided by 1.5";
    show(177, 25'000);
    EXPECT_EQ(next(), 320) << "they take less again";
    show(320, 90'000);
    EXPECT_EQ(next(), 64) << "88 fit; only parts of more than 64 sweeps are made shorter";
    show(64, 200'000);
    EXPECT_EQ(next(), 40);
}

TEST_F(Budget, NeverRunsMoreThanIsOwed) {
    (void)next();
    show(100'000, 10);
    EXPECT_EQ(next(), 4000);
    scene_.terrain.setHeight(16, 16, 1 << 24);
    sand_.emplace(scene_);
    sand_->apply({1, 1, false, {}, sand::Edit::none, std::nullopt, 1});
    ASSERT_TRUE(sand_->owed().any());
    EXPECT_EQ(next(), 3999);
}

TEST_F(Budget, AStrokeBeginsWithSixtyFourSweeps) {
    sand_->apply({1, 1, false, {}});
    ASSERT_TRUE(sand_->settled());
    EXPECT_EQ(next(true), 64) << "sand at rest";
    show(3000, 100);
    EXPECT_EQ(next(true), 64) << "a new stroke";
    sand_->apply({1, 2, true, {}});
    EXPECT_EQ(next(true), 64) << "the same stroke, without a frame that was shown";
    budget_.shown({.sweeps = 3000, .sweepNs = 300'000}, 1);
    EXPECT_EQ(next(true), 64) << "a frame from before the stroke";
    show(64, 100);
    EXPECT_EQ(next(true), 128);
}

TEST_F(Budget, AStrokeInSandThatMovesBeginsWithNoMoreThanBefore) {
    scene_.terrain.setHeight(16, 16, 1 << 24);
    sand_.emplace(scene_);
    sand_->apply({1, 1, false, {}, sand::Edit::none, std::nullopt, 1});
    ASSERT_FALSE(sand_->settled());
    (void)next();
    show(10, 1000);
    EXPECT_EQ(next(true), 20);
}

TEST_F(Budget, AnEditBeginsAsIfAllSandMoved) {
    (void)next();
    show(1000, 10);
    EXPECT_GT(next(), 1000);
    for (const sand::Edit& edit : {sand::Edit(sand::Edit::reset), sand::Edit::tuned(scene_.rules.tuning)}) {
        EXPECT_EQ(next(false, edit), 8);
    }
    EXPECT_EQ(next(), 8);
    show(8, 10);
    EXPECT_EQ(next(), 16);
}

TEST_F(Budget, OfALargeFieldBeginsWithOneSweep) {
    sand_.emplace(samples::flatScene(4000, 2000));
    EXPECT_EQ(next(), 1);
}

TEST_F(Budget, OfASmallFieldBeginsWithSixtyFourSweeps) {
    scene_ = samples::flatScene(40, 40);
    scene_.rules.tuning.sweepsPerStep = 4000;
    sand_.emplace(scene_);
    EXPECT_EQ(next(), 64);
}

TEST_F(Budget, DragAndHashTakeTheirShareAndLeaveAQuarter) {
    (void)next();
    budget_.shown({.sweeps = 4000, .substeps = 10, .sweepNs = 4'000'000, .dragNs = 10 * kMillisecond, .hashNs = 0}, 1);
    Step step{1, 1, true, {borders::probeAt(0, 0, 0), borders::probeAt(3, 0, 0)}};
    sand_->apply({1, 1, true, {}});
    ASSERT_TRUE(sand_->engaged());
    step.number = 2;
    EXPECT_EQ(budget_.sweepsOf(step, *sand_), 4000) << "of 8 ms, 4 sub-steps take 4 ms";
    for (int frame = 2; frame < 4; ++frame) {
        budget_.shown({.sweeps = 4000, .substeps = 10, .sweepNs = 8'000'000, .dragNs = 10 * kMillisecond}, 2);
    }
    EXPECT_EQ(budget_.sweepsOf(step, *sand_), 2000);
    budget_.shown({.sweeps = 4000, .substeps = 10, .sweepNs = 8'000'000, .dragNs = 90 * kMillisecond}, 2);
    EXPECT_EQ(budget_.sweepsOf(step, *sand_), 1000) << "a quarter";
}

TEST_F(Budget, SweepsAfterADragCountAsLongerByItsArea) {
    (void)next();
    sand_->apply({1, 1, true, {}});
    const Step step{1, 2, true, {borders::probeAt(0, 0, 0), borders::probeAt(3, 0, 0)}};
    budget_.shown({.sweeps = 4000, .substeps = 4, .sweepNs = 8'000'000, .dragNs = 4}, 1);
    EXPECT_EQ(budget_.sweepsOf(step, *sand_), 3999) << "measured after a drag of the same length";
    budget_.shown({.sweeps = 4000, .sweepNs = 8'000'000}, 1);
    EXPECT_EQ(budget_.sweepsOf(step, *sand_), 2666)
        << "a tool of 8 cells that moves by 4 cells moves 1.5 times the sand";
}

class BudgetOfALargeTool : public Budget {
protected:
    BudgetOfALargeTool() {
        scene_.rules.tuning.tool.radius = 40 * sand::kProbePerCell;
        scene_.rules.tuning.sweepsPerStep = 267;
        sand_.emplace(scene_);
        sand_->apply({1, 1, true, {borders::probeAt(100, 100, 0)}});
    }
    /// Returns the sweeps of a step that drags the tool by one sub-step.
    std::int32_t moved() {
        Step step{1, 2, true, {borders::probeAt(101, 100, 0)}};
        return budget_.sweepsOf(step, *sand_);
    }
    std::int32_t held() { return budget_.sweepsOf({1, 2, true, {}}, *sand_); }
};

TEST_F(BudgetOfALargeTool, TheCoarsePhaseTakesItsShareAndLeavesAQuarter) {
    ASSERT_EQ(sand_->lastWork().phases, 1);
    ASSERT_FALSE(sand_->holdsTool());
    (void)moved();
    for (const auto& [phaseMs, moving] : {std::pair(0, 8), {1, 7}, {4, 4}, {7, 2}, {70, 2}}) {
        budget_.shown({.sweeps = 40,
                       .substeps = 1,
                       .phases = 2,
                       .sweepNs = 40 * kMillisecond,
                       .phaseNs = 2 * phaseMs * kMillisecond},
                      1);
        EXPECT_EQ(moved(), moving) << phaseMs << " ms";
        EXPECT_EQ(held(), 8) << "a tool that is held has no coarse phase";
    }
    budget_.shown({.sweeps = 40, .substeps = 1, .sweepNs = 40 * kMillisecond}, 1);
    EXPECT_EQ(moved(), 2) << "a frame without a phase does not change its cost";
}

TEST_F(BudgetOfALargeTool, APathFitsBesideTheCoarsePhase) {
    for (const auto& [phaseMs, substeps] : {std::pair(0, 8), {5, 3}, {7, 2}, {70, 2}}) {
        budget_.shown({.substeps = 10, .phases = 1, .dragNs = 10 * kMillisecond, .phaseNs = phaseMs * kMillisecond}, 1);
        EXPECT_EQ(budget_.substeps(*sand_).wanted, substeps) << phaseMs << " ms";
    }
    scene_.rules.tuning.tool.radius = 12 * sand::kProbePerCell;
    EXPECT_EQ(budget_.substeps(sand::Replica(scene_)).wanted, 8) << "a smaller tool has no coarse phase";
}

TEST_F(BudgetOfALargeTool, AFrameTakesTheCoarsePhasesThatFit) {
    budget_.shown({.sweeps = 10, .phases = 1, .sweepNs = kMillisecond, .phaseNs = 3 * kMillisecond}, 1);
    const sand::Tool tool = sand_->tool();
    EXPECT_TRUE(budget_.fits({10, 0, 1}, {10, 0, 1}, tool)) << "8 ms";
    EXPECT_FALSE(budget_.fits({10, 0, 1}, {11, 0, 1}, tool));
    EXPECT_FALSE(budget_.fits({10, 0, 2}, {1, 0, 1}, tool));
    EXPECT_TRUE(budget_.fits({10, 0, 1}, {40, 0, 0}, tool));
}

TEST_F(Budget, APathFitsByTheLastTimeOfASubstep) {
    const std::int64_t most = sand_->rules().mostSubsteps();
    EXPECT_EQ(budget_.substeps(*sand_).wanted, haptic_bridge::SubstepLimit::kNone) << "no cost is known yet";
    EXPECT_EQ(budget_.substeps(*sand_).most, most);
    budget_.shown({.sweeps = 1, .substeps = 10, .sweepNs = 1, .dragNs = 20 * kMillisecond}, 1);
    EXPECT_EQ(budget_.substeps(*sand_).wanted, 4);
    budget_.shown({.sweeps = 1, .substeps = 1, .sweepNs = 1, .dragNs = 20 * kMillisecond}, 1);
    EXPECT_EQ(budget_.substeps(*sand_).wanted, 1) << "at least one";
    EXPECT_EQ(budget_.substeps(*sand_).most, most) << "no time changes what the rules allow";
}

TEST_F(Budget, AFrameTakesTheStepsThatFit) {
    const sand::Tool tool = scene_.rules.tuning.tool;  // 8 cells across
    for (const std::int64_t substeps : {2, 0}) {
        budget_.shown(
            {.sweeps = 10, .substeps = substeps, .sweepNs = 10 * kMillisecond, .dragNs = substeps * kMillisecond}, 1);
        EXPECT_TRUE(budget_.fits({4, 0}, {4, 0}, tool)) << "8 ms";
        EXPECT_FALSE(budget_.fits({4, 0}, {5, 0}, tool));
        EXPECT_TRUE(budget_.fits({2, 2}, {2, 0}, tool)) << "2 ms of drag";
        EXPECT_EQ(budget_.fits({4, 2}, {2, 0}, tool), substeps == 2) << "sweeps count as 1.25 ms after the first drag";
        EXPECT_FALSE(budget_.fits({5, 2}, {2, 0}, tool));
    }
    EXPECT_TRUE(SweepBudget(Pace::fast, kPeriod).fits({1 << 20, 0}, {1 << 20, 0}, tool));
}

TEST_F(Budget, AFrameTakesFewerLongPartsWhileSweepsTakeLongerAndLonger) {
    const sand::Tool tool = scene_.rules.tuning.tool;
    for (const std::int64_t sweepNs : {20'000, 40'000}) {
        show(100, sweepNs);
    }
    EXPECT_TRUE(budget_.fits({36, 0}, {64, 0}, tool)) << "100 sweeps of 0.04 ms each may take 8 ms";
    EXPECT_FALSE(budget_.fits({37, 0}, {64, 0}, tool));
    EXPECT_TRUE(budget_.fits({137, 0}, {63, 0}, tool)) << "a step of fewer sweeps is not a long part";
    show(100, 40'000);
    EXPECT_TRUE(budget_.fits({136, 0}, {64, 0}, tool));
}

TEST_F(Budget, TheFastPaceDependsOnNoTime) {
    SweepBudget fast(Pace::fast, kPeriod);
    for (const std::int64_t sweepNs : {1, 1000, 1'000'000'000}) {
        fast.shown({.sweeps = 64, .substeps = 8, .sweepNs = 64 * sweepNs, .dragNs = 8 * sweepNs}, 1);
        EXPECT_EQ(fast.substeps(*sand_).wanted, haptic_bridge::SubstepLimit::kNone);
        EXPECT_EQ(fast.substeps(*sand_).most, sand_->rules().mostSubsteps());
        EXPECT_EQ(fast.sweepsOf({1, 1, true, {}}, *sand_), 64);
        EXPECT_EQ(fast.sweepsOf({1, 1, true, {}, sand::Edit::reset}, *sand_), 64);
    }
    scene_.rules.tuning.sweepsPerStep = 24;
    sand_.emplace(scene_);
    EXPECT_EQ(fast.sweepsOf({1, 1, true, {}}, *sand_), 24);
}

TEST_F(Budget, StepsOfATinStateNoSweeps) {
    borders::Case given;
    given.tin = true;
    const sand::Replica sand(borders::sceneOf(given));
    EXPECT_EQ(budget_.sweepsOf({1, 1, true, {}}, sand), 0);
    EXPECT_EQ(SweepBudget(Pace::fast, kPeriod).sweepsOf({1, 1, true, {}}, sand), 0);
}

}  // namespace
