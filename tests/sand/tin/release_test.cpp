// SPDX-License-Identifier: Apache-2.0
// Sand of a TIN that a tool held back flows when the tool turns, moves or leaves.
#include <gtest/gtest.h>

#include <cstdint>

#include "tests/sand/tin/level_scene.hpp"
#include "tests/support/sand/sand_release.hpp"

namespace release {
namespace {

/// Level sand with a narrow plate of 30 cells.
scene::Scene tinPlateScene(std::int32_t spacing) {
    scene::Scene scene = tin_samples::levelScene(60, 1, spacing);
    scene.rules.tuning.sweepsPerStep = 8;
    scene.rules.tuning.tool.kind = sand::ToolKind::rectangle;
    scene.rules.tuning.tool.radius = 15 * sand::kProbePerCell;
    scene.rules.tuning.tool.halfWidth = 2 * sand::kProbePerCell;
    return scene;
}

// With a spacing, the outline of the tool changes the mesh, which wakes the sand beside it too.
TEST(TinRelease, WhatTheToolHeldBackFlowsAsInAReplicaThatHasJustJoined) {
    const sand::Heading north = *sand::headingOf(90);
    for (const std::int32_t spacing : {0, sand::kProbePerCell}) {
        SCOPED_TRACE(spacing);
        expectFlowsAsJoined(tinPlateScene(spacing), cellAt(30, 30, 12),
                            {{"turned on the spot", true, {}, north},
                             {"raised", true, {cellAt(30, 30, 40)}, {}},
                             {"raised and moved aside", true, {cellAt(30, 30, 40), cellAt(50, 50, 40)}, {}},
                             {"lifted on the spot", false, {}, {}},
                             {"lifted and turned", false, {}, north}},
                            20, 1);
    }
}

}  // namespace
}  // namespace release
