// SPDX-License-Identifier: Apache-2.0
#include "sand/replica.hpp"

#include <gtest/gtest.h>

#include <random>

#include "base/float_environment.hpp"
#include "sand/surface_factory.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/machine/other_floats.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::kProbePerCell;
using sand::ProbePoint;
using sand::Replica;
using sand::Step;

ProbePoint at(double column, double row, double height /* [cell] */) {
    return {static_cast<std::int32_t>(column * kProbePerCell), static_cast<std::int32_t>(row * kProbePerCell),
            static_cast<std::int32_t>(height * kProbePerCell)};
}

Replica dragged(const scene::Scene& scene, ProbePoint from, ProbePoint to, int steps) {
    Replica replica(scene);
    for (int i = 1; i <= steps; ++i) {
        const auto between = [&](std::int32_t a, std::int32_t b) { return a + (b - a) * i / steps; };
        replica.apply({1,
                       static_cast<std::uint64_t>(i),
                       true,
                       {{between(from.x, to.x), between(from.y, to.y), between(from.z, to.z)}}});
    }
    return replica;
}

TEST(Replica, AStrokeLeavesAFurrowWithBanks) {
    const Replica replica = dragged(samples::flatScene(96, 64), at(20, 32, 2), at(70, 32, 2), 60);
    const auto& field = samples::fieldOf(replica);
    EXPECT_LT(field.height(45, 32), -sand::kUnitsPerCell) << "the furrow";
    EXPECT_GT(field.height(45, 37), sand::kUnitsPerCell) << "the northern bank";
    EXPECT_GT(field.height(45, 26), sand::kUnitsPerCell) << "the southern bank";
    EXPECT_EQ(field.volume(), 0);
}

TEST(Replica, KnowsItsLowestAndItsHighestSand) {
    scene::Scene scene = samples::flatScene(20, 10);
    EXPECT_EQ(Replica(scene).surface().heights(), (sand::HeightSpan{0, 0}));
    scene.terrain.setHeight(19, 9, 300);
    scene.terrain.setHeight(0, 0, -70);
    EXPECT_EQ(Replica(scene).surface().heights(), (sand::HeightSpan{-70, 300}));
}

TEST(Replica, AHeldToolComesToRest) {
    scene::Scene scene = samples::flatScene(64, 64, 8);
    Replica replica(scene);
    std::uint64_t number = 0;
    replica.apply({1, ++number, true, {at(32, 32, 4)}});
    for (int i = 0; i < 2000 && !replica.settled(); ++i) {
        replica.apply({1, ++number, true, {}});
    }
    ASSERT_TRUE(replica.settled()) << "a ball held still must not move sand forever";
    const sand::HeightField rest = samples::fieldOf(replica);
    replica.apply({1, ++number, true, {}});
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), rest));
    const sand::grid::Obstacle ball = sand::grid::Displacement(scene.rules.tuning.tool).obstacle(rest, replica.probe());
    for (int y = ball.cells.y0; y < ball.cells.y1; ++y) {
        for (int x = ball.cells.x0; x < ball.cells.x1; ++x) {
            EXPECT_LE(rest.height(x, y), ball.row(y)[x - ball.cells.x0])
                << "sand inside the ball at " << x << ", " << y;
        }
    }
}

TEST(Replica, SandFallsWhenTheToolLeaves) {
    scene::Scene scene = samples::flatScene(64, 64, 8);
    scene.rules.tuning.sweepsPerStep = 2;
    Replica replica(scene);
    std::uint64_t number = 0;
    replica.apply({1, ++number, true, {at(32, 32, 0)}});
    while (!replica.settled()) {
        replica.apply({1, ++number, true, {}});
    }
    const std::int32_t held = samples::fieldOf(replica).height(32, 32);
    for (int i = 0; i < 200; ++i) {
        replica.apply({1, ++number, false, {at(32, 32, 20)}});
    }
    EXPECT_GT(samples::fieldOf(replica).height(32, 32), held);
}

TEST(Replica, VolumeIsExactWhateverTheHandDoes) {
    for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
        scene::Scene scene = samples::flatScene(45, 33, 2.56);
        scene.rules.rim = rim;
        std::mt19937 random(23);
        scene.terrain = samples::randomField(45, 33, 1 << 18, random);
        Replica replica(scene);
        for (std::uint64_t i = 1; i <= 500; ++i) {
            replica.apply(samples::randomStep(i, scene.rules, random));
            ASSERT_EQ(samples::fieldOf(replica).volume() + replica.outflow(), scene.terrain.volume()) << "step " << i;
        }
    }
}

TEST(Replica, AToolLargerThanTheFieldLosesNothing) {
    const scene::Scene scene = samples::flatScene(5, 4, 40);
    Replica replica(scene);
    replica.apply({1, 1, true, {at(2, 2, 0)}});
    EXPECT_EQ(samples::fieldOf(replica).volume(), 0);
}

TEST(Replica, HoveringLeavesTheSandAlone) {
    const scene::Scene scene = samples::flatScene(32, 32);
    Replica replica(scene);
    replica.apply({1, 1, false, {at(16, 16, -3), at(20, 16, -3)}});
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain));
    EXPECT_TRUE(replica.settled());
}

// As after a call of a driver that was compiled with fast-math. Float products round otherwise, and with them fluxes.
TEST(Replica, ComputesTheSameAlthoughItsCallerRoundsUp) {
    const scene::Scene scene = samples::flatScene(96, 64);
    Replica expected = dragged(scene, at(20, 32, 2), at(70, 32, 2), 60);
    const test::OtherFloats other;
    Replica replica = dragged(scene, at(20, 32, 2), at(70, 32, 2), 60);
    EXPECT_EQ(replica.stateHash(), expected.stateHash());
    EXPECT_EQ(base::unusualFloats(), "") << "until the next call of the driver";
}

TEST(Replica, RefusesStepsOutOfOrder) {
    Replica replica(samples::flatScene(8, 8));
    replica.apply({1, 1, false, {}});
    EXPECT_THROW(replica.apply({1, 1, false, {}}), std::logic_error);
    EXPECT_THROW(replica.apply({1, 3, false, {}}), std::logic_error);
}

TEST(Replica, GoesOnFromAStateAsIfNothingHadHappened) {
    const scene::Scene scene = samples::flatScene(70, 50);
    std::mt19937 random(29);
    Replica whole(scene);
    Replica resumed(scene);
    for (std::uint64_t i = 1; i <= 300; ++i) {
        const Step step = samples::randomStep(i, scene.rules, random);
        whole.apply(step);
        resumed.apply(step);
        if (i % 37 == 0) {
            Replica fresh(scene);
            fresh.decodeState(resumed.encodeState());
            resumed = fresh;
        }
        ASSERT_EQ(resumed.stateHash(), whole.stateHash()) << "step " << i << " of seed 29";
    }
}

// Sand that slides while the hand is away has inertia, which is part of the state.
TEST(Replica, GoesOnInMidSlide) {
    for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
        scene::Scene scene = samples::flatScene(64, 64);
        scene.terrain = samples::cylinder(64, 24, 40);
        scene.rules.rim = rim;
        Replica whole(scene);
        Replica resumed(scene);
        for (std::uint64_t i = 1; i <= 40; ++i) {
            for (Replica* replica : {&whole, &resumed}) {
                replica->apply({1, i, i == 20, {at(32, 32, i == 20 ? 0 : 100)}});
            }
            Replica fresh(scene);
            fresh.decodeState(resumed.encodeState());
            resumed = fresh;
            ASSERT_EQ(resumed.stateHash(), whole.stateHash()) << "step " << i;
        }
        EXPECT_FALSE(whole.settled());
    }
}

// A replica that joins visits every block once, while the other replica skips them. This must not make its inertia
// older.
TEST(Replica, GoesOnFromSettledSand) {
    scene::Scene scene = samples::flatScene(64, 64);
    scene.terrain = samples::cylinder(64, 12, 30);
    Replica whole(scene);
    std::uint64_t step = 0;
    while (!whole.settled()) {
        whole.apply({1, ++step, false, {}});
        ASSERT_LT(step, 10000U);
    }
    Replica joined(scene);
    joined.decodeState(whole.encodeState());
    for (int i = 0; i < 5; ++i) {
        const bool digs = i == 3;
        for (Replica* replica : {&whole, &joined}) {
            replica->apply({1, step + 1, digs, {at(32, 32, digs ? 0 : 100)}});
        }
        ++step;
        ASSERT_EQ(joined.stateHash(), whole.stateHash()) << i << " steps after joining";
    }
}

TEST(Replica, SettlesAtOnceWhenAsked) {
    scene::Scene scene = samples::flatScene(64, 64);
    scene.terrain = samples::cylinder(64, 12, 30);
    scene.rules.tuning.sweepsPerStep = 4;
    for (const bool onRock : {false, true}) {
        if (onRock) {
            scene.ground = std::make_shared<sand::Ground>(64, 64);
            scene.rules.ground = scene.ground->digest();
        }
        Replica replica(scene);
        replica.apply({1, 1, false, {}, sand::Edit::settle});
        EXPECT_TRUE(replica.settled());
        EXPECT_EQ(samples::fieldOf(replica).volume(), scene.terrain.volume());
        EXPECT_LT(samples::fieldOf(replica).height(32, 32), scene.terrain.height(32, 32))
            << "a cone, lower than its cylinder";
        const std::uint64_t incremental = replica.stateHash();
        replica.audit(replica.hashTiles().tileCount());
        EXPECT_EQ(replica.stateHash(), incremental);
    }
}

TEST(Replica, IncrementalHashEqualsAFreshOne) {
    const scene::Scene scene = samples::flatScene(70, 50);
    std::mt19937 random(31);
    Replica replica(scene);
    for (std::uint64_t i = 1; i <= 200; ++i) {
        replica.apply(samples::randomStep(i, scene.rules, random));
        const std::uint64_t incremental = replica.stateHash();
        replica.audit(replica.hashTiles().tileCount());
        ASSERT_EQ(replica.stateHash(), incremental) << "step " << i;
    }
}

TEST(Replica, AFlippedBitShowsInTheRightTile) {
    Replica replica(samples::flatScene(100, 70));
    const std::uint64_t before = replica.stateHash();
    const auto tiles = replica.hashTiles().tileHashes();
    replica.corrupt(70, 40);
    EXPECT_EQ(replica.stateHash(), before) << "no audit has run yet";
    replica.audit(replica.hashTiles().tileCount());
    EXPECT_NE(replica.stateHash(), before);
    for (int tile = 0; tile < replica.hashTiles().tileCount(); ++tile) {
        const auto i = static_cast<std::size_t>(tile);
        EXPECT_EQ(tiles[i] != replica.hashTiles().tileHashes()[i], tile == 4 + 2) << "tile " << tile;
    }
}

TEST(Replica, ChangesHoldEveryChangedCellAndEachCellOnce) {
    const scene::Scene scene = samples::flatScene(100, 70);
    std::mt19937 random(37);
    Replica replica(scene);
    (void)replica.takeChange();
    for (std::uint64_t i = 1; i <= 100; ++i) {
        const sand::HeightField before = samples::fieldOf(replica);
        replica.apply(samples::randomStep(i, scene.rules, random));
        std::vector<int> listed(100 * 70);
        for (const sand::CellRect& cells : samples::takeCells(replica)) {
            ASSERT_EQ(cells, cells.clippedTo(before.bounds()));
            for (int y = cells.y0; y < cells.y1; ++y) {
                for (int x = cells.x0; x < cells.x1; ++x) {
                    ASSERT_EQ(listed[static_cast<std::size_t>(y * 100 + x)]++, 0) << x << ", " << y;
                }
            }
        }
        for (int y = 0; y < 70; ++y) {
            for (int x = 0; x < 100; ++x) {
                ASSERT_TRUE(listed[static_cast<std::size_t>(y * 100 + x)] == 1 ||
                            before.height(x, y) == samples::fieldOf(replica).height(x, y))
                    << x << ", " << y;
            }
        }
    }
}

TEST(Replica, EverythingMayHaveChangedUntilSomebodyAsks) {
    const scene::Scene scene = samples::flatScene(40, 24);
    std::mt19937 random(41);
    Replica replica(scene);
    std::uint64_t number = 0;
    replica.apply(samples::randomStep(++number, scene.rules, random));
    EXPECT_TRUE(replica.takeChange().whole);
    sand::SurfaceChange change = replica.takeChange();
    EXPECT_FALSE(change.whole);
    EXPECT_TRUE(std::get<sand::CellChange>(change.parts).cells.empty());
    EXPECT_TRUE(Replica(replica).takeChange().whole) << "the copy is not drawn yet";
    replica.apply({1, ++number, false, {}, sand::Edit::reset});
    EXPECT_TRUE(replica.takeChange().whole);
    EXPECT_FALSE(replica.takeChange().whole);
}

TEST(Start, OfAHeightFieldAnswersForItsCells) {
    scene::Scene scene = samples::flatScene(40, 24);
    std::mt19937 random(43);
    scene.terrain = samples::randomField(40, 24, sand::kUnitsPerCell, random);
    ASSERT_NE(scene.terrain.volume(), 0);
    EXPECT_EQ(sand::volumeOf(scene), scene.terrain.volume());
    EXPECT_EQ(sand::volumeOf(scene), Replica(scene).volume());
    EXPECT_EQ(scene.leastBytes(), 16 * 40 * 24);
    EXPECT_EQ(scene.bytesToDraw(), 0) << "the cells of the replica are drawn";
    EXPECT_EQ(scene.sizeText().what, "40 x 24 cells");
    EXPECT_EQ(&std::get<sand::GridData>(scene.data()).field, &scene.terrain);
    EXPECT_EQ(sand::FieldSize::of(scene.rules), (sand::FieldSize{40, 24}));
    EXPECT_EQ(sand::FieldSize::of(scene.rules).bytesOfReplica(), scene.leastBytes());
}

TEST(Start, OfALargeToolAnswersForItsCoarsePhase) {
    scene::Scene scene = samples::flatScene(400, 800, 100);
    scene.rules.tuning.sweepsPerStep = 4000;
    EXPECT_EQ(sand::FieldSize::of(scene.rules), (sand::FieldSize{400, 800})) << "a scene file has this size, too";
    EXPECT_EQ(scene.sizeText().what, "400 x 800 cells with a tool of 100 cells");
    EXPECT_EQ(scene.sizeText().fewer, "fewer cells or a smaller tool");
    EXPECT_EQ(scene.leastBytes(), 16 * 400 * 800 + 96 * (350 * 350 / 16) + 4 * 200 * 200);
    scene.rules.tuning.tool.radius *= 3;
    EXPECT_EQ(scene.leastBytes(), 16 * 400 * 800 + 96 * (400 * 800 / 16) + 4 * 400 * 600);
}

}  // namespace
