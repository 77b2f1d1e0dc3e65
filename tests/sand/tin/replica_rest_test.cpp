// SPDX-License-Identifier: Apache-2.0
// Tools that rest on or in the sand of a TIN, and sand that comes to rest around them.
#include <cmath>
#include <fstream>
#include <memory>
#include <random>

#include "tests/sand/tin/level_scene.hpp"
#include "tests/sand/tin/tin_replica.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace tin_rests {
namespace {

using sand::Edit;
using sand::Replica;
using sand::Step;
using tin_samples::TinReplica;
using tin_samples::verticesOf;

/// Returns level sand. Its tool is a quarter as wide as the field and is pressed at random places.
scene::Scene levelSand(int side, std::uint32_t seed) {
    scene::Scene scene = tin_samples::levelScene(side, seed);
    scene.rules.tuning.sweepsPerStep = 64;
    scene.rules.tuning.tool.kind = sand::ToolKind::circle;
    scene.rules.tuning.tool.radius = 13 * sand::kProbePerCell;
    return scene;
}

// Triangles that slide under a tool are forgotten, because the tool holds their sand. They are added again beside
// triangles that start to slide. A replica that has just joined never forgot them.
TEST(TinReplicaUnderATool, WhatWasForgottenSlidesAsSoonAsItIsAskedFor) {
    constexpr std::uint32_t kSeed = 1;
    const scene::Scene scene = levelSand(100, kSeed);
    Replica replica(scene), joined(scene);
    std::mt19937 random(kSeed);
    const auto somewhere = [&random] {
        return static_cast<std::int32_t>(std::floor((26 + tin_piles::chance(random) * 48) * sand::kProbePerCell));
    };
    std::uint64_t number = 0;
    replica.apply({.epoch = 1, .number = ++number, .engaged = false, .path = {}});
    for (int imprint = 0; imprint < 6; ++imprint) {
        const std::int32_t x = somewhere();
        joined.decodeState(replica.encodeState());
        for (int i = 0; i < 6; ++i) {
            Step step{.epoch = 1, .number = ++number, .engaged = i == 0, .path = {}};
            if (i == 0) {
                step.path = {{x, somewhere(), 11 * sand::kProbePerCell}};
            }
            replica.apply(step);
            joined.apply(step);
            ASSERT_EQ(joined.stateHash(), replica.stateHash()) << "seed " << kSeed << ", step " << number;
        }
    }
}
TEST_F(TinReplica, WhatCouldNotBeRemovedCoarsensAgainOnceSandHasSlid) {
    Replica replica(scene());
    std::uint64_t number = 0;
    replica.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {{8000, 8000, 2300}, {8600, 8000, 2300}}});
    for (int vertices = 0; number < 4000;) {  // until no vertex is left that could be removed
        const int before = vertices;
        for (int i = 0; i < 100; ++i) {
            replica.apply({.epoch = 1, .number = ++number, .engaged = false, .path = {}});
        }
        vertices = verticesOf(replica);
        if (replica.settled() && vertices == before) {
            break;
        }
    }
    ASSERT_LT(number, 4000U);
    const int rested = verticesOf(replica);
    Replica joined(scene());  // the coarsening of `joined` has not examined any vertex yet
    joined.decodeState(replica.encodeState());
    sand::Tuning softer = replica.rules().tuning;
    softer.threshold /= 4;
    softer.startThreshold /= 4;
    for (int i = 0; i < 300; ++i) {
        const Step step{.epoch = 1,
                        .number = ++number,
                        .engaged = false,
                        .path = {},
                        .edit = i == 0 ? Edit::tuned(softer) : Edit(Edit::none)};
        replica.apply(step);
        joined.apply(step);
        ASSERT_EQ(joined.stateHash(), replica.stateHash()) << "step " << number;
    }
    EXPECT_LT(verticesOf(replica), rested) << "flat sand needs fewer vertices";
}

TEST_F(TinReplica, AtRestNoStepChangesItsMesh) {
    Replica replica(scene());
    EXPECT_FALSE(replica.atRest()) << "no sweep has looked";
    std::uint64_t number = 0;
    const auto hover = [&] { replica.apply({.epoch = 1, .number = ++number, .engaged = false, .path = {}}); };
    replica.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {{8000, 8000, 2300}, {8600, 8000, 2300}}});
    EXPECT_FALSE(replica.atRest());
    while (number < 4000 && !replica.atRest()) {
        hover();
    }
    ASSERT_TRUE(replica.atRest());
    const int vertices = verticesOf(replica);
    (void)replica.takeChange();
    for (int i = 0; i < 500; ++i) {
        hover();
        ASSERT_TRUE(replica.atRest()) << number;
    }
    EXPECT_EQ(verticesOf(replica), vertices);
    const sand::SurfaceChange change = replica.takeChange();
    const auto& parts = std::get<sand::TinChange>(change.parts);
    EXPECT_TRUE(parts.triangles.empty() && parts.vertices.empty());
    Replica joined(scene());
    joined.decodeState(replica.encodeState());
    EXPECT_FALSE(joined.atRest()) << "it has not looked at any vertex";
}

TEST_F(TinReplica, EveryStepIsAFunctionOfTheStateWhileAToolSettlesOnSlopes) {
    const scene::Scene start = scene();
    Replica replica(start), fresh(start);
    for (std::uint64_t number = 1; number <= 160; ++number) {
        // The tool is held still for nine steps, in which the sand comes to rest. Then it is pressed a little farther
        // on.
        const auto place = static_cast<std::int32_t>(number / 10);
        const Step step{.epoch = 1,
                        .number = number,
                        .engaged = true,
                        .path = {{3000 + 600 * place, 8000 + 150 * (place % 3), 2500 + 40 * (place % 5)}}};
        fresh.decodeState(replica.encodeState());
        fresh.apply(step);
        replica.apply(step);
        ASSERT_EQ(fresh.stateHash(), replica.stateHash()) << "step " << number;
    }
}

// A flat tool comes down exactly to the height of one vertex of a slope at rest, and takes no sand. This vertex now
// leans on the tool. A vertex that leans may only make its triangles flatter, also where the sand beside it lies beyond
// an obtuse angle. So the slope stays at rest.
TEST_F(TinReplica, NoSandSlidesBecauseItLeansOnAToolWhichHasMovedNone) {
    constexpr int kPoints = 60, kRise = 9;  // kRise / 16: slopes of 0.56 under a talus of 0.67
    std::mt19937 random(3);
    std::ofstream survey(folder_ / "survey.csv");
    survey << "0 0 0\n16 0 9\n0 16 0\n16 16 9\n";
    std::vector<sand::ProbePoint> places;
    for (int i = 0; i < kPoints; ++i) {
        const auto x = static_cast<int>(random() % 224 + 16), y = static_cast<int>(random() % 224 + 16);
        survey << x / 16.0 << ' ' << y / 16.0 << ' ' << x * kRise / 256.0 << '\n';
        places.push_back({16 * x, 16 * y, kRise * x});
    }
    survey.close();
    std::ofstream(folder_ / "slope.toml") << "[terrain]\nkind = \"points\"\nfile = \"survey.csv\"\n[tin]\ncell = 1\n"
                                             "max_error = 0\nvertices = "
                                          << kPoints + 4  // so that the tool's outline gets no vertices
                                          << "\n[material]\ntalus_deg = 34\n[tool]\nshape = \"circle\"\nradius = 0.5\n";
    const scene::Scene scene = scene::loadScene(folder_ / "slope.toml");
    int slid = 0;
    for (sand::ProbePoint probe : places) {
        probe.z += scene.rules.tuning.tool.radius;
        Replica replica(scene), fresh(scene);
        replica.apply({.epoch = 1, .number = 1, .engaged = false, .path = {}});
        ASSERT_TRUE(replica.settled());
        fresh.decodeState(replica.encodeState());
        for (Replica* one : {&replica, &fresh}) {
            one->apply({.epoch = 1, .number = 2, .engaged = true, .path = {probe}});
        }
        ASSERT_EQ(fresh.stateHash(), replica.stateHash()) << probe.x << ", " << probe.y;
        slid += replica.settled() ? 0 : 1;
    }
    EXPECT_EQ(slid, 0);
}

TEST_F(TinReplica, ComesToRestAndThenCostsNoChange) {
    Replica replica(scene());
    std::uint64_t number = 0;
    replica.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {{8000, 8000, 2300}, {8600, 8000, 2300}}});
    while (number < 4000 && !replica.settled()) {
        replica.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {}});
    }
    ASSERT_TRUE(replica.settled()) << "a tool that is held still must not pump sand without end";
    (void)replica.takeChange();
    const auto held = replica.copySand()->encode();
    replica.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {}});
    EXPECT_EQ(replica.copySand()->encode(), held);
    const sand::SurfaceChange change = replica.takeChange();
    EXPECT_FALSE(change.whole);
    const auto& parts = std::get<sand::TinChange>(change.parts);
    EXPECT_TRUE(parts.triangles.empty() && parts.vertices.empty());
}
}  // namespace
}  // namespace tin_rests
