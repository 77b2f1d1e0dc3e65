// SPDX-License-Identifier: Apache-2.0
// Sand that a tool held back flows when the tool turns, moves or leaves.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "sand/replica.hpp"
#include "tests/support/sand_samples.hpp"

namespace release {
namespace {

using sand::kProbePerCell;
using sand::ProbePoint;
using sand::Replica;
using sand::Step;

ProbePoint cellAt(int column, int row, int height) {
    return {column * kProbePerCell, row * kProbePerCell, height * kProbePerCell};
}

/// Level sand with a narrow plate of 40 cells, which is easily turned.
scene::Scene plateScene() {
    scene::Scene scene = samples::flatScene(90, 90, 20);
    scene.rules.toolKind = sand::ToolKind::rectangle;
    scene.rules.toolHalfWidth = 2 * kProbePerCell;
    scene.rules.sweepsPerStep = 1;  // so that blocks at rest do not wake within a step
    return scene;
}

/// Returns sand at rest around a plate that is 4 cells deep and points east.
Replica heldSand(const scene::Scene& scene) {
    Replica terrain(scene);
    terrain.apply({1, 1, true, {cellAt(45, 45, 16)}});
    while (!terrain.settled()) {
        terrain.apply({1, terrain.stepNumber() + 1, true, {}});
    }
    return terrain;
}

struct Way {
    const char* name;
    bool engaged;
    std::vector<ProbePoint> path;
    std::optional<sand::Heading> heading;
};

// All blocks of a replica that joins are awake. So the sand that the tool held back there flows without a release.
TEST(Release, WhatTheToolHeldBackFlowsAsInAReplicaThatHasJustJoined) {
    const scene::Scene scene = plateScene();
    const Replica held = heldSand(scene);
    const sand::Heading north = *sand::headingOf(90);
    for (const Way& way : {Way{"turned on the spot", true, {}, north},
                           {"turned where it is put again", true, {cellAt(45, 45, 16)}, north},
                           {"raised", true, {cellAt(45, 45, 40)}, {}},
                           {"raised and moved aside", true, {cellAt(45, 45, 40), cellAt(80, 80, 40)}, {}},
                           {"raised and turned", true, {cellAt(45, 45, 40)}, north},
                           {"lifted on the spot", false, {}, {}},
                           {"lifted elsewhere", false, {cellAt(45, 45, 40), cellAt(80, 80, 40)}, {}},
                           {"lifted and turned", false, {}, north}}) {
        Replica terrain(held), joined(scene);
        joined.decodeState(terrain.encodeState());
        ASSERT_TRUE(terrain.settled());
        Step step{1, terrain.stepNumber() + 1, way.engaged, way.path};
        step.heading = way.heading;
        for (int i = 0; i < 30; ++i) {
            terrain.apply(step);
            joined.apply(step);
            ASSERT_EQ(terrain.stateHash(), joined.stateHash()) << way.name << ", step " << i;
            step = {1, step.number + 1, way.engaged, {}};
        }
        EXPECT_FALSE(terrain.settled()) << way.name;
    }
}

// The far end of the plate is 20 cells from its middle, and the plate that points north does not reach it. The cell is
// in the northernmost row of the imprint, beside the sand that leans on the plate.
TEST(Release, ATurnedToolLetsTheSandAtItsOldEndsFall) {
    Replica terrain = heldSand(plateScene());
    const auto atTheEnd = [&terrain] { return terrain.surface().height(63.5 * kProbePerCell, 46.5 * kProbePerCell); };
    const double before = atTheEnd();
    ASSERT_LT(before, -3.9 * sand::kUnitsPerCell) << "the bottom of the plate's imprint";
    Step step{1, terrain.stepNumber() + 1, true, {}};
    step.heading = *sand::headingOf(90);
    terrain.apply(step);
    EXPECT_GT(atTheEnd(), before) << "after a single sweep";
}

}  // namespace
}  // namespace release
