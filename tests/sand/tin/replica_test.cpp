// SPDX-License-Identifier: Apache-2.0
#include "sand/replica.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/float_environment.hpp"
#include "base/input_error.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/sand/tin/same_session.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/other_floats.hpp"
#include "tests/support/sand_of.hpp"
#include "tests/support/tin_piles.hpp"

namespace {

using sand::Edit;
using sand::Replica;
using sand::Step;

/// A scene file as a person writes it: dunes on 64 x 64 nominal cells, as a TIN.
class TinTerrain : public test::FolderTest {
protected:
    [[nodiscard]] scene::Scene scene(const std::string& tin = "max_error = 0.01\n", const std::string& more = "",
                                     const std::string& rim = "") const {
        const std::filesystem::path file = folder_ / "scene.toml";
        std::ofstream(file) << rim
                            << "[field]\ncolumns = 64\nwidth = 2.0\n[terrain]\nkind = \"dunes\"\nheight = 0.3\n"
                               "dune_height = 0.15\ndune_length = 0.8\n"
                            << more << "[tin]\n"
                            << tin << "[material]\ntalus_deg = 34\nsettling_time = 0.1\n[tool]\nradius = 0.1\n";
        return scene::loadScene(file);
    }
};

int verticesOf(const Replica& terrain) {
    const auto& alive = samples::tinOf(terrain).triangles.triangleAt;
    return static_cast<int>(std::count_if(alive.begin(), alive.end(), [](std::int32_t at) { return at >= 0; }));
}

/// Returns random strokes, with all edits that a hand and an operator can make.
std::vector<Step> session(std::uint32_t seed, int steps) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t most) { return static_cast<std::int32_t>(random() % most); };
    std::vector<Step> all;
    sand::ProbePoint at{64 * 128, 64 * 128, 2600};
    for (int i = 0; i < steps; ++i) {
        Step step{.epoch = 1, .number = static_cast<std::uint64_t>(i + 1), .engaged = i % 16 < 11, .path = {}};
        for (int points = below(4); points > 0; --points) {
            at = {std::clamp(at.x + below(601) - 300, -2000, 64 * 256 + 2000),
                  std::clamp(at.y + below(601) - 300, -2000, 64 * 256 + 2000), 2400 + below(1200)};
            step.path.push_back(at);
        }
        if (i % 16 == 0) {
            at = {below(64 * 256), below(64 * 256), 3000};
            step.path = {at};
        }
        step.edit = i % 50 == 49 ? Edit::undo : i == steps / 2 ? Edit::settle : Edit::none;
        all.push_back(step);
    }
    return all;
}

TEST_F(TinTerrain, ASessionIsTheSameTwiceAndFromItsMiddle) {
    const scene::Scene start = scene();
    ASSERT_NE(start.tin, nullptr);
    ASSERT_LT(start.tin->places.size(), 64U * 64U / 2);
    tin_samples::expectSameSession(start, start, session(7, 120), 37);
}

// A copy computes the heights of all vertices again from volumes and areas.
TEST_F(TinTerrain, ACopyIsTheSameAlthoughItsCallerRoundsUp) {
    const Replica terrain(scene());
    const auto heightsOf = [](const Replica& replica) { return samples::tinOf(replica).heights; };
    const test::OtherFloats other;
    const Replica copy(terrain);
    EXPECT_EQ(base::unusualFloats(), "");
    EXPECT_EQ(heightsOf(copy), heightsOf(terrain));
}

TEST_F(TinTerrain, OverAnOpenRimASessionIsTheSameTwiceAndCountsWhatFalls) {
    const scene::Scene start = scene("max_error = 0.01\n", "", "rim = \"open\"\n");
    // After each step, volume and outflow must add up to the first volume.
    tin_samples::expectSameSession(start, scene::Scene::decode(start.encode()), session(7, 120), 37);
    Replica terrain(start);
    for (const Step& step : session(7, 120)) {
        const std::int64_t before = terrain.outflow();
        terrain.apply(step);
        if (step.edit.kind == Edit::none) {
            EXPECT_GE(terrain.outflow(), before) << "step " << step.number;
        }
    }
    EXPECT_GT(terrain.outflow(), terrain.volume() / 100);
    terrain.apply({.epoch = 1, .number = 121, .engaged = false, .path = {}, .edit = Edit::reset});
    EXPECT_EQ(terrain.outflow(), 0);
    EXPECT_EQ(terrain.copySand()->encode(), Replica(start).copySand()->encode());
}

TEST_F(TinTerrain, OverAnOpenRimSandFallsBeforeTheSessionWhereTheSceneSettles) {
    const scene::Scene settled = scene("max_error = 0.01\n", "settle = true\n", "rim = \"open\"\n");
    Replica terrain(settled);
    EXPECT_EQ(terrain.outflow(), 0) << "the outflow must not count sand that fell before the session";
    EXPECT_LT(terrain.volume(), Replica(scene("max_error = 0.01\n", "", "rim = \"open\"\n")).volume());
    for (std::uint64_t number = 1; number <= 20; ++number) {
        terrain.apply({.epoch = 1, .number = number, .engaged = false, .path = {}});
    }
    // The start rounds heights to whole units. The sand that this adds, half a unit of height at most, may fall.
    EXPECT_LE(terrain.outflow(), std::int64_t{6} * 64 * 64 * 65536 / 2);
}

/// Returns level sand on random points. Its tool is a quarter as wide as the field and is pressed at random places.
scene::Scene levelSand(int side, std::uint32_t seed) {
    sand::tin::TinStart start = tin_piles::levelStart(side, seed);
    start.settings.spacing = start.settings.maxError = 0;
    start.settings.mostVertices = 1 << 19;
    scene::Scene scene;
    scene.rules.columns = scene.rules.rows = side;
    scene.rules.threshold = 65536;
    scene.rules.startThreshold = 65536 + 65536 / 1000;
    scene.rules.sweepsPerStep = 64;
    scene.rules.toolKind = sand::ToolKind::circle;
    scene.rules.toolRadius = 13 * sand::kProbePerCell;
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    return scene;
}

// Triangles that slide under a tool are forgotten, because the tool holds their sand. They are added again beside
// triangles that start to slide. A replica that has just joined never forgot them.
TEST(TinTerrainUnderATool, WhatWasForgottenSlidesAsSoonAsItIsAskedFor) {
    constexpr std::uint32_t kSeed = 1;
    const scene::Scene scene = levelSand(100, kSeed);
    Replica terrain(scene), joined(scene);
    std::mt19937 random(kSeed);
    const auto somewhere = [&random] {
        return static_cast<std::int32_t>(std::floor((26 + tin_piles::chance(random) * 48) * sand::kProbePerCell));
    };
    std::uint64_t number = 0;
    terrain.apply({.epoch = 1, .number = ++number, .engaged = false, .path = {}});
    for (int imprint = 0; imprint < 6; ++imprint) {
        const std::int32_t x = somewhere();
        joined.decodeState(terrain.encodeState());
        for (int i = 0; i < 6; ++i) {
            Step step{.epoch = 1, .number = ++number, .engaged = i == 0, .path = {}};
            if (i == 0) {
                step.path = {{x, somewhere(), 11 * sand::kProbePerCell}};
            }
            terrain.apply(step);
            joined.apply(step);
            ASSERT_EQ(joined.stateHash(), terrain.stateHash()) << "seed " << kSeed << ", step " << number;
        }
    }
}

// docs/terrain.md has these figures. The volume of the sand is exact. Samples are not, because the surface bends
// between them. Their error falls with the square of their distance.
TEST_F(TinTerrain, CutAndFillDifferByWhatSamplesMiss) {
    const Replica before(scene());
    Replica after(scene());
    for (Step step : session(7, 120)) {
        step.edit = {};
        after.apply(step);
    }
    ASSERT_EQ(after.volume(), before.volume());
    const auto apart = [&](int perCell) {
        double cut = 0, fill = 0;
        for (int y = 0; y < 64 * perCell; ++y) {
            for (int x = 0; x < 64 * perCell; ++x) {
                const double east = 256 * (x + 0.5) / perCell, north = 256 * (y + 0.5) / perCell;
                const double change = after.surface().height(east, north) - before.surface().height(east, north);
                (change < 0 ? cut : fill) += std::abs(change);
            }
        }
        return std::abs(fill - cut) / fill;
    };
    const double coarse = apart(1), fine = apart(8);
    fmt::print("cut and fill are {:.1f} % apart, and {:.3f} % of samples an eighth as far\n", 100 * coarse, 100 * fine);
    EXPECT_NEAR(coarse, 0.011, 0.001);  // docs/terrain.md
    EXPECT_NEAR(fine, 0.00007, 0.00001);
}

TEST_F(TinTerrain, TravelsWholeWithItsScene) {
    const scene::Scene start = scene("max_error = 0.02\nspacing = 0.05\nkeep_constraints = true\n");
    const scene::Scene read = scene::Scene::decode(start.encode());
    ASSERT_NE(read.tin, nullptr);
    EXPECT_EQ(read.rules, start.rules);
    EXPECT_EQ(read.tin->places, start.tin->places);
    EXPECT_EQ(read.tin->settings, start.tin->settings);
    EXPECT_EQ(Replica(read).stateHash(), Replica(start).stateHash());
    EXPECT_EQ(read.referenceHeight(), start.referenceHeight());
}

TEST_F(TinTerrain, ResetUndoAndLoadPutTheSandBack) {
    const scene::Scene start = scene();
    Replica terrain(start);
    const std::int64_t volume = terrain.volume();
    const auto untouched = terrain.surface().valuesOf(0);
    const base::Bytes saved = terrain.copySand()->encode();
    for (const Step& step : session(3, 20)) {
        terrain.apply(step);
    }
    EXPECT_NE(terrain.surface().valuesOf(0), untouched);
    terrain.apply({.epoch = 1, .number = 21, .engaged = false, .path = {}, .edit = Edit::reset});
    EXPECT_EQ(terrain.surface().valuesOf(0), untouched);
    EXPECT_EQ(terrain.copySand()->encode(), saved);
    EXPECT_EQ(terrain.volume(), volume);
    terrain.apply({.epoch = 1, .number = 22, .engaged = true, .path = {{8000, 8000, 2000}}});
    ASSERT_NE(terrain.copySand()->encode(), saved);
    terrain.apply({.epoch = 1, .number = 23, .engaged = false, .path = {}, .edit = Edit::undo});
    EXPECT_EQ(terrain.copySand()->encode(), saved);
    terrain.apply({.epoch = 1, .number = 24, .engaged = true, .path = {{8000, 8000, 2000}}});
    terrain.apply({.epoch = 1, .number = 25, .engaged = false, .path = {}, .edit = Edit::loaded(saved)});
    EXPECT_EQ(terrain.copySand()->encode(), saved);
}

TEST_F(TinTerrain, WhatHasLookedInVainCoarsensAgainOnceSandHasSlid) {
    Replica terrain(scene());
    std::uint64_t number = 0;
    terrain.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {{8000, 8000, 2300}, {8600, 8000, 2300}}});
    for (int vertices = 0; number < 4000;) {  // until no vertex is left that could be removed
        const int before = vertices;
        for (int i = 0; i < 100; ++i) {
            terrain.apply({.epoch = 1, .number = ++number, .engaged = false, .path = {}});
        }
        vertices = verticesOf(terrain);
        if (terrain.settled() && vertices == before) {
            break;
        }
    }
    ASSERT_LT(number, 4000U);
    const int rested = verticesOf(terrain);
    Replica joined(scene());  // the coarsening of `joined` has not examined any vertex yet
    joined.decodeState(terrain.encodeState());
    sand::Tuning softer = terrain.rules().tuning();
    softer.threshold /= 4;
    softer.startThreshold /= 4;
    for (int i = 0; i < 300; ++i) {
        const Step step{.epoch = 1,
                        .number = ++number,
                        .engaged = false,
                        .path = {},
                        .edit = i == 0 ? Edit::tuned(softer) : Edit(Edit::none)};
        terrain.apply(step);
        joined.apply(step);
        ASSERT_EQ(joined.stateHash(), terrain.stateHash()) << "step " << number;
    }
    EXPECT_LT(verticesOf(terrain), rested) << "flat sand needs fewer vertices";
}

TEST_F(TinTerrain, EveryStepIsAFunctionOfTheStateWhileAToolSettlesOnSlopes) {
    const scene::Scene start = scene();
    Replica terrain(start), fresh(start);
    for (std::uint64_t number = 1; number <= 160; ++number) {
        // The tool is held still for nine steps, in which the sand comes to rest. Then it is pressed a little farther
        // on.
        const auto place = static_cast<std::int32_t>(number / 10);
        const Step step{.epoch = 1,
                        .number = number,
                        .engaged = true,
                        .path = {{3000 + 600 * place, 8000 + 150 * (place % 3), 2500 + 40 * (place % 5)}}};
        fresh.decodeState(terrain.encodeState());
        fresh.apply(step);
        terrain.apply(step);
        ASSERT_EQ(fresh.stateHash(), terrain.stateHash()) << "step " << number;
    }
}

// A flat tool comes down exactly to the height of one vertex of a slope at rest, and takes no sand. This vertex now
// leans on the tool and counts as high as the sand beside it. If that sand lies beyond an obtuse angle, the slope
// becomes steeper.
TEST_F(TinTerrain, SandSlidesThatLeansOnAToolWhichHasMovedNone) {
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
    for (sand::ProbePoint at : places) {
        at.z += scene.rules.toolRadius;
        Replica terrain(scene), fresh(scene);
        terrain.apply({.epoch = 1, .number = 1, .engaged = false, .path = {}});
        ASSERT_TRUE(terrain.settled());
        fresh.decodeState(terrain.encodeState());
        for (Replica* one : {&terrain, &fresh}) {
            one->apply({.epoch = 1, .number = 2, .engaged = true, .path = {at}});
        }
        ASSERT_EQ(fresh.stateHash(), terrain.stateHash()) << at.x << ", " << at.y;
        slid += terrain.settled() ? 0 : 1;
    }
    EXPECT_GT(slid, 0) << "no slope became steep enough to slide";
}

TEST_F(TinTerrain, ComesToRestAndThenCostsNoChange) {
    Replica terrain(scene());
    std::uint64_t number = 0;
    terrain.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {{8000, 8000, 2300}, {8600, 8000, 2300}}});
    while (number < 4000 && !terrain.settled()) {
        terrain.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {}});
    }
    ASSERT_TRUE(terrain.settled()) << "a tool that is held still must not pump sand without end";
    (void)terrain.takeChange();
    const auto held = terrain.copySand()->encode();
    terrain.apply({.epoch = 1, .number = ++number, .engaged = true, .path = {}});
    EXPECT_EQ(terrain.copySand()->encode(), held);
    const sand::SurfaceChange change = terrain.takeChange();
    EXPECT_FALSE(change.whole);
    const auto& parts = std::get<sand::TinChange>(change.parts);
    EXPECT_TRUE(parts.triangles.empty() && parts.vertices.empty());
}

TEST_F(TinTerrain, AFlippedBitShowsInTheNextAudit) {
    Replica terrain(scene());
    const std::uint64_t right = terrain.stateHash();
    terrain.corrupt(40, 13, 3);
    EXPECT_EQ(terrain.stateHash(), right) << "corrupt() must not update the hash";
    terrain.audit(terrain.hashTiles().tileCount());
    EXPECT_NE(terrain.stateHash(), right);
}

TEST_F(TinTerrain, ChangesNameAllThatChanged) {
    Replica terrain(scene());
    ASSERT_TRUE(terrain.takeChange().whole);
    auto triangles = samples::tinOf(terrain).triangles;
    auto heights = samples::tinOf(terrain).heights;
    for (const Step& step : session(11, 40)) {
        if (step.edit.any()) {
            continue;
        }
        Step next = step;
        next.number = terrain.stepNumber() + 1;
        terrain.apply(next);
        const sand::SurfaceChange change = terrain.takeChange();
        ASSERT_FALSE(change.whole);
        const auto& [changedTriangles, changedVertices] = std::get<sand::TinChange>(change.parts);
        const sand::tin::Triangles& now = samples::tinOf(terrain).triangles;
        for (std::size_t slot = 0; slot < now.triangles.size(); ++slot) {
            const bool same = slot < triangles.triangles.size() &&
                              triangles.triangles[slot].corner == now.triangles[slot].corner &&
                              triangles.triangles[slot].constrained == now.triangles[slot].constrained;
            ASSERT_TRUE(same || std::ranges::binary_search(changedTriangles, static_cast<std::int32_t>(slot)))
                << "step " << next.number << ", slot " << slot;
        }
        for (std::size_t vertex = 0; vertex < now.triangleAt.size(); ++vertex) {
            const bool alive = now.alive(static_cast<sand::tin::Vertex>(vertex));
            const bool same = vertex < heights.size() &&
                              alive == triangles.alive(static_cast<sand::tin::Vertex>(vertex)) &&
                              (!alive || (heights[vertex] == samples::tinOf(terrain).heights[vertex] &&
                                          triangles.places[vertex] == now.places[vertex]));
            ASSERT_TRUE(same || std::ranges::binary_search(changedVertices, static_cast<std::int32_t>(vertex)))
                << "step " << next.number << ", vertex " << vertex;
        }
        triangles = now;
        heights = samples::tinOf(terrain).heights;
    }
}

TEST_F(TinTerrain, IsMadeOfTheSurveyPointsThemselves) {
    std::ofstream(folder_ / "survey.csv") << "x,y,z\n100,200,3\n110,200,5\n110,205,7\n104,203,4\n";
    std::ofstream(folder_ / "points.toml") << "[terrain]\nkind = \"points\"\nfile = \"survey.csv\"\n[tin]\ncell = 0.5\n"
                                              "[material]\ntalus_deg = 34\n[tool]\nradius = 1\n";
    const scene::Scene read = scene::loadScene(folder_ / "points.toml");
    ASSERT_NE(read.tin, nullptr);
    EXPECT_EQ(read.rules.columns, 20);
    EXPECT_EQ(read.rules.rows, 10);
    ASSERT_EQ(read.tin->places.size(), 5U) << "three points at corners, one within the field, and the fourth corner";
    const Replica terrain(read);
    const auto height = [&](double x, double y) {
        return terrain.surface().height((x - 100) / 0.5 * 256, (y - 200) / 0.5 * 256) * 0.5 / 65536;
    };
    EXPECT_DOUBLE_EQ(height(100, 200), 3);
    EXPECT_DOUBLE_EQ(height(110, 200), 5);
    EXPECT_DOUBLE_EQ(height(104, 203), 4);
    EXPECT_DOUBLE_EQ(height(100, 205), 4) << "a corner without a point is as high as the nearest point";
}

TEST_F(TinTerrain, SaysHowManySurveyPointsItDoesNotTellApart) {
    const auto warnings = [&](const std::string& cell) {
        std::ofstream(folder_ / "survey.csv") << "5.001 5 51\n0 0 0\n0.002 0 -3\n10 0 0\n0 10 0\n5 5 1\n5.002 5 21\n";
        std::ofstream(folder_ / "points.toml")
            << "[terrain]\nkind = \"points\"\nfile = \"survey.csv\"\n[tin]\ncell = " << cell
            << "\n[material]\ntalus_deg = 34\n[tool]\nradius = 10\n";
        const scene::Scene read = scene::loadScene(folder_ / "points.toml");
        EXPECT_EQ(read.tin->places.size(), read.warnings.empty() ? 8U : 5U) << "with the missing corner";
        return read.warnings;
    };
    EXPECT_EQ(warnings("5"),
              std::vector{(folder_ / "survey.csv").string() +
                          ": 3 points lie within 0.0195 of another, which a TIN of such cells cannot separate; the "
                          "first in the file was taken, others were up to 50 higher or lower; set a smaller "
                          "cell in [tin]"});
    EXPECT_EQ(warnings("0.1"), std::vector<std::string>{});
}

TEST_F(TinTerrain, RefusesWhatItCannotHoldInOneLine) {
    const auto complaint = [this](const std::string& tin, const std::string& more) -> std::string {
        try {
            (void)scene(tin, more);
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "nothing";
    };
    for (const auto& [tin, more, part] :
         {std::tuple{"max_error = -1\n", "", "max_error"}, std::tuple{"vertices = 3\n", "", "vertices"},
          std::tuple{"spacing = 0\n", "", "spacing"}, std::tuple{"", "layer = 0.1\n", "a TIN has no rock"},
          std::tuple{"colour = 1\n", "", "colour"}}) {
        const std::string said = complaint(tin, more);
        EXPECT_NE(said.find(part), std::string::npos) << said;
        EXPECT_NE(said.find("scene.toml:"), std::string::npos) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
    std::ofstream(folder_ / "survey.csv") << "0 0 0\n10 0 0\n0 10 0\n";
    std::ofstream(folder_ / "points.toml")
        << "[terrain]\nkind = \"points\"\nfile = \"survey.csv\"\nlayer = 0.1\n[tin]\n"
           "[material]\n[tool]\nradius = 1\n";
    try {
        (void)scene::loadScene(folder_ / "points.toml");
        FAIL() << "accepted";
    } catch (const base::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("points.toml:5: a TIN has no rock"), std::string::npos)
            << error.what();
    }
}

}  // namespace
