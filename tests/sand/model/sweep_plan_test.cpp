// SPDX-License-Identifier: Apache-2.0
#include "sand/model/sweep_plan.hpp"

#include <gtest/gtest.h>

#include "sand/model/rules.hpp"

namespace {

using sand::SweepPlan;

sand::Tuning tuningOf(std::int32_t cells, std::int32_t sweeps) {
    sand::Tuning tuning{.threshold = 1, .startThreshold = 1, .sweepsPerStep = sweeps};
    tuning.tool.radius = cells * sand::kProbePerCell;
    return tuning;
}

/// Returns the plan of a tool with the default settling time, at 60 steps a second.
SweepPlan usualPlan(std::int32_t cells) { return sand::gridSweepPlan(tuningOf(cells, (cells * cells + 5) / 6)); }

TEST(SweepPlan, LeavesToolsUpToSixteenCellsAsTheyWere) {
    for (std::int32_t cells = 0; cells <= 16; ++cells) {
        for (const std::int32_t sweeps : {1, 4, 43, 4096}) {
            EXPECT_EQ(sand::gridSweepPlan(tuningOf(cells, sweeps)), (SweepPlan{sweeps, sweeps, 0, 0, 0})) << cells;
        }
    }
    EXPECT_EQ(sand::gridSweepPlan(tuningOf(16, 9999)).moved, sand::kMostSweeps);
    sand::Tuning larger = tuningOf(16, 43);
    ++larger.tool.radius;
    EXPECT_TRUE(sand::gridSweepPlan(larger).hasCoarsePhase());
}

TEST(SweepPlan, CarriesSandAsFarAsAllSweeps) {
    EXPECT_EQ(usualPlan(30), (SweepPlan{8, 30, 4, 4, 10}));
    EXPECT_EQ(usualPlan(61), (SweepPlan{8, 61, 4, 4, 39}));
    EXPECT_EQ(usualPlan(100), (SweepPlan{8, 64, 8, 4, 27}));
    EXPECT_EQ(usualPlan(150), (SweepPlan{8, 64, 8, 4, 59}));
    EXPECT_EQ(usualPlan(400), (SweepPlan{8, 64, 32, 4, 27}));
    EXPECT_EQ(usualPlan(2048), (SweepPlan{8, 64, 128, 4, 43}));
    EXPECT_EQ(sand::gridSweepPlan(tuningOf(20, 10000)), (SweepPlan{8, 20, 4, 4, 625}))
        << "larger cells do not resolve it";
    EXPECT_EQ(sand::gridSweepPlan(tuningOf(20, sand::kMostSweepsToRest)), (SweepPlan{8, 20, 4, 4, sand::kMostSweeps}));
    for (std::int32_t cells = 17; cells <= 2048; ++cells) {
        const SweepPlan plan = usualPlan(cells);
        ASSERT_GE(plan.coarsest * plan.coarsest * plan.coarsestSweeps, (cells * cells + 5) / 6) << cells;
        ASSERT_TRUE(plan.coarsest == plan.finest || 6 * plan.coarsest <= cells) << cells;
        ASSERT_EQ(plan.sweepsOf(plan.coarsest), plan.coarsestSweeps);
    }
}

TEST(SweepPlan, HasNoCoarsePhaseIfFewSweepsAreEnough) {
    EXPECT_EQ(sand::gridSweepPlan(tuningOf(61, 61)), (SweepPlan{61, 61, 0, 0, 0}));
    EXPECT_EQ(sand::gridSweepPlan(tuningOf(61, 62)), (SweepPlan{8, 61, 4, 4, 4}));
    EXPECT_EQ(sand::gridSweepPlan(tuningOf(400, 64)), (SweepPlan{64, 64, 0, 0, 0}));
}

TEST(SweepPlan, HasCellsThatResolveANarrowTool) {
    const auto planOf = [](double width) {
        sand::Tuning tuning = tuningOf(200, 6667);
        tuning.tool.kind = sand::ToolKind::rectangle;
        tuning.tool.halfWidth = static_cast<std::int32_t>(tuning.tool.radius * width);
        return sand::gridSweepPlan(tuning);
    };
    EXPECT_EQ(planOf(1).coarsest, 16);
    EXPECT_EQ(planOf(0.25), (SweepPlan{8, 64, 8, 2, 105}));
    EXPECT_EQ(planOf(0.05), (SweepPlan{8, 64, 4, 2, 417}));
    EXPECT_EQ(planOf(0.03), (SweepPlan{4096, 4096, 0, 0, 0})) << "it is narrower than 16 cells";
}

TEST(SweepPlan, HasAFinerLevelBesideCorners) {
    using enum sand::ToolKind;
    sand::Tuning tuning = tuningOf(61, 621);
    for (const auto& [kind, finest] :
         {std::pair(sphere, 4), {circle, 4}, {rectangle, 2}, {ellipse, 2}, {ellipsoid, 2}, {footprint, 2}}) {
        tuning.tool.kind = kind;
        tuning.tool.halfWidth = sand::isRound(kind) ? 0 : tuning.tool.radius / 2;
        const SweepPlan plan = sand::gridSweepPlan(tuning);
        EXPECT_EQ(plan.finest, finest);
        EXPECT_EQ(plan.coarsest, 4);
        EXPECT_EQ(plan.sweepsOf(2), SweepPlan::kFinerSweeps);
    }
}

TEST(SweepPlan, LetsAStepOfATinRunAllSweeps) {
    sand::Rules rules;
    rules.tuning = tuningOf(61, 621);
    EXPECT_TRUE(rules.sweepPlan().hasCoarsePhase());
    EXPECT_EQ(rules.substepLength(), 61 * sand::kProbePerCell / 16);
    rules.tin = 1;
    EXPECT_EQ(rules.sweepPlan(), (SweepPlan{621, 621, 0, 0, 0}));
    EXPECT_EQ(rules.sweepPlan(tuningOf(2048, 699051)), (SweepPlan{4096, 4096, 0, 0, 0}));
    EXPECT_EQ(rules.substepLength(), sand::kProbePerCell);
}

}  // namespace
