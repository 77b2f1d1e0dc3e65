// SPDX-License-Identifier: Apache-2.0
// Tools of every kind with a coarse phase: no sand comes into them, and their steps can be divided and undone.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/sand/coarse/limits.hpp"
#include "tests/sand/spread/sessions.hpp"
#include "tests/support/borders/border_scenes.hpp"
#include "tests/support/borders/tool_kinds.hpp"

namespace {

using borders::Case;
using borders::probeAt;
using sand::ToolKind;

/// Returns uneven sand for a tool of 61 cells. Coarse cells do not divide its sides.
Case uneven(ToolKind kind) {
    Case field;
    field.columns = 201;
    field.rows = 173;
    field.height = [](double x, double y) { return 20 + 8 * std::sin(x / 15) * std::cos(y / 11); };
    field.tool = kind;
    field.radius = 61;
    field.sweeps = (61 * 61 + 5) / 6;
    return field;
}

/// Returns a path of a step from west to east, 0.8 radii deep.
std::vector<sand::ProbePoint> pathFrom(double x, double y) {
    std::vector<sand::ProbePoint> path;
    for (int sample = 0; sample < 4; ++sample) {
        path.push_back(probeAt(x + 2 * sample, y + sample, 20 + 0.2 * 61));
    }
    return path;
}

struct Held {
    std::string name;
    Case field;
    double x, y;  // of the first press [cell]
};

/// Returns places in the middle, half outside the field, and over walls and rock below the tool.
std::vector<Held> places(ToolKind kind) {
    std::vector<Held> all{{"in the middle", uneven(kind), 80, 80},
                          {"beyond a closed rim", uneven(kind), 178, 80},
                          {"beyond a corner of an open rim", uneven(kind), -5, -7},
                          {"over a wall", uneven(kind), 60, 80},
                          {"over a ridge of rock", uneven(kind), 60, 80}};
    all[2].field.rim = sand::Rim::open;
    all[3].field.wall = [](int x, int) { return x == 90; };
    all[4].field.rock = [](double x, double) { return x > 90 && x < 93 ? 40.0 : -60.0; };
    return all;
}

TEST(HeldLargeTool, KeepsAllSandOut) {
    for (const ToolKind kind : support::everyTool()) {
        for (const Held& held : places(kind)) {
            SCOPED_TRACE(std::string(base::nameOf(kind)) + ", " + held.name);
            const scene::Scene scene = borders::sceneOf(held.field);
            sand::Replica sand(scene);
            for (int step = 0; step < 4; ++step) {
                (void)coarse::applyWithinLimits(
                    sand, scene,
                    {.number = 0, .engaged = true, .path = pathFrom(held.x + 8 * step, held.y + 4 * step)});
                EXPECT_EQ(held.field.rock ? 0 : borders::overUnderside(sand, sand.probe()), 0) << step;
            }
            for (int step = 0; step < 10; ++step) {
                borders::Hand(sand).hold();
            }
            EXPECT_EQ(held.field.rock ? 0 : borders::overUnderside(sand, sand.probe()), 0);
        }
    }
}

/// Returns a stroke with a turn, another tool and a rest in the sand, and its undo.
std::vector<sand::Step> strokeIn(const scene::Scene& scene) {
    sand::Tuning foot = scene.rules.tuning;
    foot.tool.kind = ToolKind::footprint;
    foot.tool.halfWidth = foot.tool.radius / 2;
    return {{.number = 0, .engaged = true, .path = pathFrom(60, 80)},
            {.number = 0, .engaged = true, .path = pathFrom(68, 84)},
            {.number = 0, .engaged = true},
            {.number = 0, .engaged = true, .path = {}, .edit = sand::Edit::tuned(foot)},
            {.number = 0, .engaged = true, .path = pathFrom(76, 88), .heading = sand::Heading{11585, 11585, true}},
            {.number = 0, .engaged = false, .path = {probeAt(150, 150, 90)}},
            {.number = 0, .engaged = false},
            {.number = 0, .engaged = false, .path = {}, .edit = sand::Edit::undo}};
}

TEST(HeldLargeTool, LeavesTheSameSandInPartsOfAnySizeUntilItIsUndone) {
    Case field = uneven(ToolKind::sphere);
    field.rim = sand::Rim::open;
    field.rock = [](double x, double y) { return 10 * std::sin(x / 9) * std::cos(y / 7) - 4; };
    const scene::Scene scene = borders::sceneOf(field);
    std::mt19937 random(61);
    sand::Replica whole(scene);
    const auto start = whole.copySand()->encode();
    std::vector<spread::Parts> parts;
    for (const int most : {1, 7, 16, 64}) {
        parts.emplace_back(scene, most, sand::grid::Erosion::Options{}, sand::grid::Erosion::Options{.blockSize = 13});
    }
    int phases = 0;
    for (const sand::Step& step : strokeIn(scene)) {
        phases += whole.hasCoarsePhase(step) ? 1 : 0;
        spread::applyWhole(whole, step);
        for (spread::Parts& each : parts) {
            EXPECT_EQ(each.apply(step, random), "") << "parts of " << each.most();
            EXPECT_TRUE(spread::sandOf(each.sand()) == spread::sandOf(whole)) << "parts of " << each.most();
        }
    }
    EXPECT_EQ(phases, 5);
    EXPECT_TRUE(whole.copySand()->encode() == start) << "after the undo";
}

}  // namespace
