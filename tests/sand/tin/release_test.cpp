// SPDX-License-Identifier: Apache-2.0
// Sand of a TIN that a tool held back flows when the tool turns, moves or leaves.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "sand/replica.hpp"
#include "scene/scene.hpp"
#include "tests/support/tin_piles.hpp"

namespace tin_release {
namespace {

using sand::kProbePerCell;
using sand::ProbePoint;
using sand::Replica;
using sand::Step;

ProbePoint cellAt(int column, int row, int height) {
    return {column * kProbePerCell, row * kProbePerCell, height * kProbePerCell};
}

/// Level sand on random points, with a narrow plate of 30 cells.
scene::Scene plateScene() {
    constexpr int kSide = 60;
    sand::tin::TinStart start = tin_piles::levelStart(kSide, 1);
    start.settings.spacing = kProbePerCell;
    start.settings.maxError = 0;
    start.settings.mostVertices = 1 << 19;
    scene::Scene scene;
    scene.rules.columns = scene.rules.rows = kSide;
    scene.rules.threshold = 65536;
    scene.rules.startThreshold = 65536 + 65536 / 1000;
    scene.rules.sweepsPerStep = 8;
    scene.rules.toolKind = sand::ToolKind::rectangle;
    scene.rules.toolRadius = 15 * kProbePerCell;
    scene.rules.toolHalfWidth = 2 * kProbePerCell;
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    return scene;
}

struct Way {
    const char* name;
    bool engaged;
    std::vector<ProbePoint> path;
    std::optional<sand::Heading> heading;
};

// A replica that joins examines all of its sand. So the sand that the tool held back there flows without a release.
TEST(TinRelease, WhatTheToolHeldBackFlowsAsInAReplicaThatHasJustJoined) {
    const scene::Scene scene = plateScene();
    Replica held(scene);
    held.apply({1, 1, true, {cellAt(30, 30, 12)}});
    while (!held.settled() && held.stepNumber() < 5000) {
        held.apply({1, held.stepNumber() + 1, true, {}});
    }
    ASSERT_TRUE(held.settled());
    const base::Bytes state = held.encodeState();
    const sand::Heading north = *sand::headingOf(90);
    for (const Way& way : {Way{"turned on the spot", true, {}, north},
                           {"raised", true, {cellAt(30, 30, 40)}, {}},
                           {"raised and moved aside", true, {cellAt(30, 30, 40), cellAt(50, 50, 40)}, {}},
                           {"lifted on the spot", false, {}, {}},
                           {"lifted and turned", false, {}, north}}) {
        Replica terrain(held), joined(scene);
        joined.decodeState(state);
        Step step{1, terrain.stepNumber() + 1, way.engaged, way.path};
        step.heading = way.heading;
        for (int i = 0; i < 20; ++i) {
            terrain.apply(step);
            joined.apply(step);
            ASSERT_EQ(terrain.stateHash(), joined.stateHash()) << way.name << ", step " << i;
            EXPECT_TRUE(i > 0 || !terrain.settled()) << way.name;
            step = {1, step.number + 1, way.engaged, {}};
        }
    }
}

}  // namespace
}  // namespace tin_release
