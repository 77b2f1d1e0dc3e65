// SPDX-License-Identifier: Apache-2.0
#include "sand/replica.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/float_environment.hpp"
#include "sand/surface_factory.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "sand/tin/surface.hpp"
#include "tests/sand/tin/same_session.hpp"
#include "tests/sand/tin/tin_replica.hpp"
#include "tests/support/machine/other_floats.hpp"

namespace {

using sand::Edit;
using sand::Replica;
using sand::Step;
using tin_samples::session;
using tin_samples::TinReplica;

TEST_F(TinReplica, ASessionIsTheSameTwiceAndFromItsMiddle) {
    const scene::Scene start = scene();
    ASSERT_NE(start.tin, nullptr);
    ASSERT_LT(start.tin->places.size(), 64U * 64U / 2);
    tin_samples::expectSameSession(start, start, session(7, 120), 37);
}

// A copy computes the heights of all vertices again from volumes and areas.
TEST_F(TinReplica, ACopyIsTheSameAlthoughItsCallerRoundsUp) {
    const Replica replica(scene());
    const auto heightsOf = [](const Replica& one) { return samples::tinOf(one).heights; };
    const test::OtherFloats other;
    const Replica copy(replica);  // NOLINT(performance-unnecessary-copy-initialization): the copy is tested
    EXPECT_EQ(base::unusualFloats(), "");
    EXPECT_EQ(heightsOf(copy), heightsOf(replica));
}

TEST_F(TinReplica, OverAnOpenRimASessionIsTheSameTwiceAndCountsWhatFalls) {
    const scene::Scene start = scene("max_error = 0.01\n", "", "rim = \"open\"\n");
    // After each step, volume and outflow must add up to the first volume.
    tin_samples::expectSameSession(start, scene::Scene::decode(start.encode()), session(7, 120), 37);
    Replica replica(start);
    for (const Step& step : session(7, 120)) {
        const std::int64_t before = replica.outflow();
        replica.apply(step);
        if (step.edit.kind == Edit::none) {
            EXPECT_GE(replica.outflow(), before) << "step " << step.number;
        }
    }
    EXPECT_GT(replica.outflow(), replica.volume() / 100);
    replica.apply({.epoch = 1, .number = 121, .engaged = false, .path = {}, .edit = Edit::reset});
    EXPECT_EQ(replica.outflow(), 0);
    EXPECT_EQ(replica.copySand()->encode(), Replica(start).copySand()->encode());
}

TEST_F(TinReplica, OverAnOpenRimSandFallsBeforeTheSessionWhereTheSceneSettles) {
    const scene::Scene settled = scene("max_error = 0.01\n", "settle = true\n", "rim = \"open\"\n");
    Replica replica(settled);
    EXPECT_EQ(replica.outflow(), 0) << "the outflow must not count sand that fell before the session";
    EXPECT_LT(replica.volume(), Replica(scene("max_error = 0.01\n", "", "rim = \"open\"\n")).volume());
    for (std::uint64_t number = 1; number <= 20; ++number) {
        replica.apply({.epoch = 1, .number = number, .engaged = false, .path = {}});
    }
    // The start rounds heights to whole units. The sand that this adds, half a unit of height at most, may fall.
    EXPECT_LE(replica.outflow(), std::int64_t{6} * 64 * 64 * 65536 / 2);
}

// docs/terrain.md has these figures. The volume of the sand is exact. Samples are not, because the surface bends
// between them. Their error falls with the square of their distance.
TEST_F(TinReplica, CutAndFillDifferByWhatSamplesMiss) {
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

TEST_F(TinReplica, TravelsWholeWithItsScene) {
    const scene::Scene start = scene("max_error = 0.02\nspacing = 0.05\nkeep_constraints = true\n");
    const scene::Scene read = scene::Scene::decode(start.encode());
    ASSERT_NE(read.tin, nullptr);
    EXPECT_EQ(read.rules, start.rules);
    EXPECT_EQ(read.tin->places, start.tin->places);
    EXPECT_EQ(read.tin->settings, start.tin->settings);
    EXPECT_EQ(Replica(read).stateHash(), Replica(start).stateHash());
    EXPECT_EQ(read.referenceHeight(), start.referenceHeight());
}

TEST_F(TinReplica, AStartAnswersForItsVerticesAndItsNominalCells) {
    const scene::Scene start = scene();
    EXPECT_EQ(sand::volumeOf(start), Replica(start).volume());
    const std::int64_t vertices = static_cast<std::int64_t>(start.tin->places.size());
    EXPECT_EQ(start.leastBytes(), 320 * vertices);
    EXPECT_EQ(start.bytesToDraw(), 4 * 64 * 64) << "a height per nominal cell";
    EXPECT_EQ(start.sizeText().what, fmt::format("a TIN's {} vertices over 64 x 64 nominal cells", vertices));
    const sand::FieldSize size = sand::FieldSize::of(start.rules);
    EXPECT_EQ(size, (sand::FieldSize{64, 64, true}));
    EXPECT_NE(size, (sand::FieldSize{64, 64}));
    EXPECT_FALSE(size.bytesOfReplica().has_value()) << "the rules do not say how many vertices there are";
    EXPECT_EQ(size.leastBytes(), 4 * 64 * 64) << "the heights from which the TIN is made";
    EXPECT_THROW((void)start.data(), std::logic_error);
}

TEST_F(TinReplica, KnowsItsLowestAndItsHighestSand) {
    scene::Scene start = scene();
    auto changed = std::make_shared<sand::tin::TinStart>(*start.tin);
    const auto [lowest, highest] = std::ranges::minmax(changed->heights);
    changed->heights.back() = highest + 5 * sand::kUnitsPerCell;
    changed->heights.at(changed->heights.size() / 2) = lowest - 3 * sand::kUnitsPerCell;
    start.tin = changed;
    start.rules.tin = changed->digest();
    const sand::HeightSpan span = Replica(start).surface().heights();
    // A vertex gets its height from its volume, which is a whole number.
    EXPECT_NEAR(span.lowest, lowest - 3 * sand::kUnitsPerCell, 1);
    EXPECT_NEAR(span.highest, highest + 5 * sand::kUnitsPerCell, 1);
}

TEST_F(TinReplica, ResetUndoAndLoadPutTheSandBack) {
    const scene::Scene start = scene();
    Replica replica(start);
    const std::int64_t volume = replica.volume();
    const auto untouched = replica.surface().valuesOf(0);
    const base::Bytes saved = replica.copySand()->encode();
    for (const Step& step : session(3, 20)) {
        replica.apply(step);
    }
    EXPECT_NE(replica.surface().valuesOf(0), untouched);
    replica.apply({.epoch = 1, .number = 21, .engaged = false, .path = {}, .edit = Edit::reset});
    EXPECT_EQ(replica.surface().valuesOf(0), untouched);
    EXPECT_EQ(replica.copySand()->encode(), saved);
    EXPECT_EQ(replica.volume(), volume);
    replica.apply({.epoch = 1, .number = 22, .engaged = true, .path = {{8000, 8000, 2000}}});
    ASSERT_NE(replica.copySand()->encode(), saved);
    replica.apply({.epoch = 1, .number = 23, .engaged = false, .path = {}, .edit = Edit::undo});
    EXPECT_EQ(replica.copySand()->encode(), saved);
    replica.apply({.epoch = 1, .number = 24, .engaged = true, .path = {{8000, 8000, 2000}}});
    replica.apply({.epoch = 1, .number = 25, .engaged = false, .path = {}, .edit = Edit::loaded(saved)});
    EXPECT_EQ(replica.copySand()->encode(), saved);
}

// Sand at rest starts to slide only on a steeper slope than sand that moves.
TEST_F(TinReplica, ALoadRestoresWhichSandMoves) {
    Replica replica(scene());
    for (const Step& step : session(3, 8)) {
        replica.apply(step);
    }
    const auto moving = [&replica] {
        const auto& all = dynamic_cast<const sand::tin::TinSurface&>(replica.surface()).layer().moving();
        return std::count(all.begin(), all.end(), 1);
    };
    const auto moved = moving();
    ASSERT_GT(moved, 0);
    const base::Bytes saved = replica.copySand()->encode();
    for (std::uint64_t number = 9; number < 20; ++number) {
        replica.apply({.epoch = 1, .number = number, .engaged = false, .path = {}});
    }
    ASSERT_NE(replica.copySand()->encode(), saved);
    replica.apply({.epoch = 1, .number = 20, .engaged = false, .path = {}, .edit = Edit::loaded(saved)});
    EXPECT_EQ(moving(), moved);
    EXPECT_EQ(replica.copySand()->encode(), saved);
}

// A slide would hide a vertex that the tool has changed and that was not marked for the undo.
TEST_F(TinReplica, AnUndoRestoresSandThatDoesNotSlide) {
    scene::Scene start = scene();
    start.rules.tuning.threshold = start.rules.tuning.startThreshold = sand::kLargestThreshold;
    Replica replica(start);
    const auto stroke = [&replica](std::int32_t x) {
        for (std::int32_t y = 4000; y <= 12000; y += 1000) {
            replica.apply({.epoch = 1, .number = replica.stepNumber() + 1, .engaged = true, .path = {{x, y, 2000}}});
        }
        replica.apply({.epoch = 1, .number = replica.stepNumber() + 1, .engaged = false, .path = {}});
    };
    stroke(5000);
    const base::Bytes first = replica.copySand()->encode();
    stroke(5600);
    ASSERT_NE(replica.copySand()->encode(), first);
    replica.apply({.epoch = 1, .number = replica.stepNumber() + 1, .engaged = false, .path = {}, .edit = Edit::undo});
    EXPECT_EQ(replica.copySand()->encode(), first);
}

TEST_F(TinReplica, AnUndoRestoresTheConstraintsOfEarlierStrokes) {
    Replica replica(scene("max_error = 0.01\nkeep_constraints = true\n"));
    const auto stroke = [&replica](std::int32_t x) {
        replica.apply({.epoch = 1, .number = replica.stepNumber() + 1, .engaged = true, .path = {{x, 8000, 2000}}});
        replica.apply({.epoch = 1, .number = replica.stepNumber() + 1, .engaged = false, .path = {}});
    };
    const auto constraints = [&replica] {
        int sides = 0;
        for (const sand::tin::Triangle& triangle : samples::tinOf(replica).triangles.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                sides += triangle.alive() && triangle.neighbour[k] >= 0 && triangle.constrained[k] ? 1 : 0;
            }
        }
        return sides;
    };
    stroke(4000);
    const base::Bytes first = replica.copySand()->encode();
    const int sides = constraints();
    ASSERT_GT(sides, 0);
    stroke(12000);
    ASSERT_GT(constraints(), sides);
    replica.apply({.epoch = 1, .number = replica.stepNumber() + 1, .engaged = false, .path = {}, .edit = Edit::undo});
    EXPECT_EQ(constraints(), sides);
    EXPECT_EQ(replica.copySand()->encode(), first);
}

TEST_F(TinReplica, AFlippedBitShowsInTheNextAudit) {
    Replica replica(scene());
    const std::uint64_t right = replica.stateHash();
    replica.corrupt(40, 13, 3);
    EXPECT_EQ(replica.stateHash(), right) << "corrupt() must not update the hash";
    replica.audit(replica.hashTiles().tileCount());
    EXPECT_NE(replica.stateHash(), right);
}

TEST_F(TinReplica, ChangesNameAllThatChanged) {
    Replica replica(scene());
    ASSERT_TRUE(replica.takeChange().whole);
    auto triangles = samples::tinOf(replica).triangles;
    auto heights = samples::tinOf(replica).heights;
    for (const Step& step : session(11, 40)) {
        if (step.edit.any()) {
            continue;
        }
        Step next = step;
        next.number = replica.stepNumber() + 1;
        replica.apply(next);
        const sand::SurfaceChange change = replica.takeChange();
        ASSERT_FALSE(change.whole);
        const auto& [changedTriangles, changedVertices] = std::get<sand::TinChange>(change.parts);
        const sand::tin::Triangles& now = samples::tinOf(replica).triangles;
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
                              (!alive || (heights[vertex] == samples::tinOf(replica).heights[vertex] &&
                                          triangles.places[vertex] == now.places[vertex]));
            ASSERT_TRUE(same || std::ranges::binary_search(changedVertices, static_cast<std::int32_t>(vertex)))
                << "step " << next.number << ", vertex " << vertex;
        }
        triangles = now;
        heights = samples::tinOf(replica).heights;
    }
}
}  // namespace
