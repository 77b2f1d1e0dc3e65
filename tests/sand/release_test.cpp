// SPDX-License-Identifier: Apache-2.0
// Sand that a tool held back flows when the tool turns, moves or leaves.
#include <gtest/gtest.h>

#include "sand/replica.hpp"
#include "tests/support/sand/sand_release.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace release {
namespace {

using sand::kProbePerCell;
using sand::Replica;
using sand::Step;

/// Level sand with a narrow plate of 40 cells, which is easily turned.
scene::Scene plateScene() {
    scene::Scene scene = samples::flatScene(90, 90, 20);
    scene.rules.tuning.tool.kind = sand::ToolKind::rectangle;
    scene.rules.tuning.tool.halfWidth = 2 * kProbePerCell;
    scene.rules.tuning.sweepsPerStep = 1;  // so that blocks at rest do not wake within a step
    return scene;
}

const sand::ProbePoint kPlate = cellAt(45, 45, 16);  // 4 cells deep; the plate points east

TEST(Release, WhatTheToolHeldBackFlowsAsInAReplicaThatHasJustJoined) {
    const sand::Heading north = *sand::headingOf(90);
    expectFlowsAsJoined(plateScene(), kPlate,
                        {{"turned on the spot", true, {}, north},
                         {"turned where it is put again", true, {kPlate}, north},
                         {"raised", true, {cellAt(45, 45, 40)}, {}},
                         {"raised and moved aside", true, {cellAt(45, 45, 40), cellAt(80, 80, 40)}, {}},
                         {"raised and turned", true, {cellAt(45, 45, 40)}, north},
                         {"lifted on the spot", false, {}, {}},
                         {"lifted elsewhere", false, {cellAt(45, 45, 40), cellAt(80, 80, 40)}, {}},
                         {"lifted and turned", false, {}, north}},
                        30, 30);
}

// The far end of the plate is 20 cells from its middle, and the plate that points north does not reach it. The cell is
// in the northernmost row of the imprint, beside the sand that leans on the plate.
TEST(Release, ATurnedToolLetsTheSandAtItsOldEndsFall) {
    Replica replica(plateScene());
    ASSERT_NO_FATAL_FAILURE(hold(replica, kPlate));
    const auto atTheEnd = [&replica] { return replica.surface().height(63.5 * kProbePerCell, 46.5 * kProbePerCell); };
    const double before = atTheEnd();
    ASSERT_LT(before, -3.9 * sand::kUnitsPerCell) << "the bottom of the plate's imprint";
    Step step{1, replica.stepNumber() + 1, true, {}};
    step.heading = *sand::headingOf(90);
    replica.apply(step);
    EXPECT_GT(atTheEnd(), before) << "after a single sweep";
}

}  // namespace
}  // namespace release
