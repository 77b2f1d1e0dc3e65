// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/flow/erosion.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sand/tin/flow/settle.hpp"
#include "tests/sand/tin/rough_layer.hpp"

namespace erosion {
namespace {

using namespace tin_piles;
using namespace rough_layers;
using sand::Rim;
using sand::tin::Erosion;
using sand::tin::Wide;

constexpr std::int32_t kTalus = 65536;  // [unit per cell], 45 degrees
constexpr std::array kKinds{Kind::regular, Kind::jittered, Kind::random};

/// Sets the heights to a plane that rises by `slope` [unit per cell] in the direction `degrees`.
void incline(VertexSand& layer, double slope, double degrees) {
    const double east = slope * std::cos(degrees * std::numbers::pi / 180) / kCell;
    const double north = slope * std::sin(degrees * std::numbers::pi / 180) / kCell;
    for (const Vertex vertex : mesh_checks::livingVertices(layer.mesh())) {
        const LatticePoint& place = layer.triangles().places[static_cast<std::size_t>(vertex)];
        layer.setHeight(vertex, static_cast<std::int32_t>(std::floor(east * place.x + north * place.y + 0.5)));
    }
}

TEST(TinErosion, ASlopeUpToTheTalusIsLeftAloneBitByBit) {
    for (const Kind kind : kKinds) {
        VertexSand layer = layerOf(kind, 24);
        for (int degrees = 0; degrees < 360; degrees += 15) {
            incline(layer, kTalus, degrees);
            const base::Bytes before = bytesOf(layer);
            std::vector<Vertex> moved;
            EXPECT_EQ(Erosion(layer, kTalus, kTalus).sweep(layer, 100, nullptr, moved), 1) << degrees;
            EXPECT_TRUE(moved.empty());
            EXPECT_EQ(bytesOf(layer), before) << nameOf(kind) << ", " << degrees;
        }
        incline(layer, 1.01 * kTalus, 30);
        std::vector<Vertex> moved;
        Erosion(layer, kTalus, kTalus).sweep(layer, 1, nullptr, moved);
        EXPECT_FALSE(moved.empty()) << nameOf(kind) << ": a steeper slope moves";
    }
}

TEST(TinErosion, EverySweepKeepsVolumeAndExtremesAndLowersTheEnergy) {
    for (const std::int32_t range : {1000, 1 << 20, 1 << 28}) {
        VertexSand layer = roughLayer(3000, 150, range, 11);
        const Wide volume = layer.volume();
        Extremes before = extremesOf(layer);
        double energy = energyOf(layer);
        Erosion erosion(layer, kTalus / 16, kTalus / 16);
        std::vector<Vertex> moved;
        for (int sweep = 0; sweep < 1000 && !erosion.settled(); ++sweep) {
            moved.clear();
            erosion.sweep(layer, 1, nullptr, moved);
            ASSERT_TRUE(layer.volume() == volume) << "seed 11, sweep " << sweep;
            const Extremes after = extremesOf(layer);
            ASSERT_GE(after.lowest, before.lowest) << "seed 11, sweep " << sweep;
            ASSERT_LE(after.highest, before.highest) << "seed 11, sweep " << sweep;
            before = after;
            const double now = energyOf(layer);
            // The energy may fall by less than a sum of doubles resolves.
            ASSERT_LE(now, energy * (1 + 1e-13)) << "seed 11, sweep " << sweep;
            energy = now;
        }
    }
}

TEST(TinErosion, TwoVerticesDoNotSwapForEver) {
    // Large stars lie on both sides of a small one, or small stars on both sides of a large one. With one step for all
    // edges, the sand would never come to rest.
    for (const std::int32_t apart : {1, 16, 400, 1900}) {
        sand::tin::Mesh mesh(4000, 4000);
        const Vertex one = mesh.insert({2000, 2000});
        const Vertex other = mesh.insert({2000 + apart, 2000});
        VertexSand layer(std::move(mesh));
        layer.setHeight(one, 1 << 28);
        layer.setHeight(other, -(1 << 28));
        const sand::tin::Settled settled = sand::tin::settle(layer, kTalus, kTalus, 20'000);
        EXPECT_TRUE(settled.atRest) << apart << " apart, " << settled.sweeps << " sweeps";
    }
}

TEST(TinErosion, SandAtRestIsAFixedPoint) {
    for (const Kind kind : kKinds) {
        VertexSand layer = layerOf(kind, 16);
        std::mt19937 random(5);
        for (const Vertex vertex : mesh_checks::livingVertices(layer.mesh())) {
            layer.setHeight(vertex, heightWithin(4 * kTalus, random));
        }
        ASSERT_TRUE(sand::tin::settle(layer, kTalus, kTalus).atRest);
        const base::Bytes rest = bytesOf(layer);
        EXPECT_EQ(sand::tin::settle(layer, kTalus, kTalus).sweeps, 1);
        EXPECT_EQ(bytesOf(layer), rest);
        // At rest, no triangle is steeper than the talus by more than a part in 1024, up to rounding. Sweeps do not
        // move sand within this margin.
        sand::tin::settle(layer, kTalus + kTalus / 1000, kTalus + kTalus / 1000);
        EXPECT_EQ(bytesOf(layer), rest);
    }
}

TEST(TinErosion, ActiveEdgesGiveWhatAllEdgesGive) {
    struct Case {
        std::int32_t threshold, start;
        Rim rim;
    };
    // One band is so narrow that sand comes to rest within it.
    for (const auto& [threshold, start, rim] :
         {Case{kTalus, kTalus, Rim::closed}, Case{kTalus, kTalus * 5 / 4, Rim::closed},
          Case{kTalus, kTalus + kTalus / 2000, Rim::closed}, Case{kTalus, kTalus, Rim::open},
          Case{kTalus, kTalus * 5 / 4, Rim::open}}) {
        VertexSand some = layerOf(Kind::random, 24);
        std::mt19937 random(7);
        for (int lump = 0; lump < 5; ++lump) {
            const double x = 24 * chance(random), y = 24 * chance(random);
            for (const Vertex vertex : mesh_checks::livingVertices(some.mesh())) {
                const LatticePoint& place = some.triangles().places[static_cast<std::size_t>(vertex)];
                const double away = std::hypot(place.x / 256.0 - x, place.y / 256.0 - y);
                if (away < 2.5) {
                    some.setHeight(vertex, 2 * kTalus * lump);
                }
            }
        }
        VertexSand all = restored(some);
        Erosion active(some, threshold, start, rim);
        std::int64_t fell = 0;
        std::vector<Vertex> moved, movedOfAll;
        for (int step = 0; step < 60; ++step) {
            moved.clear();
            movedOfAll.clear();
            const int sweeps = step % 10 == 9 ? 400 : 20;  // 400 sweeps forget many edges
            active.sweep(some, sweeps, nullptr, moved);
            Erosion fresh(all, threshold, start, rim);
            fresh.sweep(all, sweeps, nullptr, movedOfAll);
            ASSERT_EQ(bytesOf(some), bytesOf(all)) << "seed 7, step " << step;
            ASSERT_EQ(moved, movedOfAll);
            const std::int64_t outflow = active.takeOutflow();
            ASSERT_EQ(outflow, fresh.takeOutflow()) << "seed 7, step " << step;
            fell += outflow;
            if (step % 20 == 10) {  // add a load to sand that is at rest
                const auto top = static_cast<Vertex>(4 + random() % 500);
                some.add(top, 1'000'000'000'000);
                all.add(top, 1'000'000'000'000);
                active.wake({top});
            }
        }
        EXPECT_EQ(fell > 0, rim == Rim::open);
    }
}

void restoreWhileTheMeshChanges(Rim rim) {
    VertexSand layer = roughLayer(2000, 80, 1 << 20, 13);
    constexpr std::int32_t kSlide = kTalus / 8, kStart = kSlide + kSlide / 1500;
    Erosion erosion(layer, kSlide, kStart, rim);
    std::mt19937 random(17);
    std::vector<Vertex> moved;
    for (int step = 0; step < 60; ++step) {
        VertexSand other = restored(layer);  // the slots of `other` differ, and all its sand is awake
        Erosion fresh(other, kSlide, kStart, rim);
        std::mt19937 same = random;
        const auto edit = [](VertexSand& edited, std::mt19937& chances) {
            edited.edit([&](sand::tin::Mesh& mesh) { mesh_checks::editAtRandom(mesh, chances, 100); });
        };
        edit(layer, random);
        edit(other, same);
        erosion.changed(layer, layer.takeChange());
        fresh.changed(other, other.takeChange());
        // A tool is in the sand, moves on, and is away for some steps.
        const int moves = step / 4;
        const sand::tin::Underside held = [moves](LatticePoint place) {
            const bool under = std::hypot(place.x - 1000.0 - 20 * moves, place.y - 1000.0) < 600;
            return under ? 1 << 15 : std::numeric_limits<std::int32_t>::max();
        };
        const sand::tin::Underside* const tool = step % 16 < 12 ? &held : nullptr;
        for (const Vertex vertex : mesh_checks::livingVertices(layer.mesh())) {
            const auto i = static_cast<std::size_t>(vertex);
            if (tool != nullptr && layer.heights()[i] > held(layer.triangles().places[i]) - 1.0) {
                erosion.wake({vertex});
            }
        }
        erosion.sweep(layer, 20, tool, moved);
        fresh.sweep(other, 20, tool, moved);
        ASSERT_EQ(bytesOf(layer), bytesOf(other)) << "seeds 13 and 17, step " << step;
        ASSERT_EQ(erosion.takeOutflow(), fresh.takeOutflow()) << "seeds 13 and 17, step " << step;
    }
}

TEST(TinErosion, ARestoredReplicaGoesOnAlikeWhileTheMeshChanges) {
    restoreWhileTheMeshChanges(Rim::closed);
    restoreWhileTheMeshChanges(Rim::open);
}

TEST(TinErosion, NoSandRisesAboveAToolThatStandsInIt) {
    VertexSand layer = layerOf(Kind::jittered, 24);
    fill(layer, [](double x, double) { return x < 12 ? 9.0 : 0.0; });
    const std::int32_t underside = kTalus / 2;
    const sand::tin::Underside held = [&](LatticePoint place) {
        const bool under = std::hypot(place.x / 256.0 - 16, place.y / 256.0 - 12) < 3;
        return under ? underside : std::numeric_limits<std::int32_t>::max();
    };
    const auto highestUnder = [&] {
        double highest = 0;
        for (const Vertex vertex : mesh_checks::livingVertices(layer.mesh())) {
            if (held(layer.triangles().places[static_cast<std::size_t>(vertex)]) == underside) {
                highest = std::max(highest, layer.heights()[static_cast<std::size_t>(vertex)]);
            }
        }
        return highest;
    };
    // Sand that is higher than the underside at the start stays or sinks.
    const double most = std::max<double>(highestUnder(), underside);
    Erosion erosion(layer, kTalus, kTalus);
    std::vector<Vertex> moved;
    erosion.sweep(layer, 100'000, &held, moved);
    EXPECT_TRUE(erosion.settled()) << "a tool that is held still pumps sand without end";
    EXPECT_LE(highestUnder(), most);
    EXPECT_GT(highestUnder(), 0.9 * underside) << "no sand was held back";
    moved.clear();
    erosion.sweep(layer, 64, &held, moved);
    EXPECT_TRUE(moved.empty());
    erosion.sweep(layer, 100'000, nullptr, moved);  // without wake(): erosion itself must find the sand
    EXPECT_GT(highestUnder(), 2 * most);
    const base::Bytes rest = bytesOf(layer);
    sand::tin::settle(layer, kTalus, kTalus);
    EXPECT_EQ(bytesOf(layer), rest) << "some sand that the tool had held back was not examined again";
}

TEST(TinErosion, ABankStandsUntilTheStartThresholdAndThenSlidesUntilTheThreshold) {
    VertexSand layer = layerOf(Kind::jittered, 24);
    incline(layer, 1.5 * kTalus, 20);
    EXPECT_EQ(sand::tin::settle(layer, kTalus, 2 * kTalus).sweeps, 1);
    const auto edge = static_cast<Vertex>(mesh_checks::livingVertices(layer.mesh()).size() / 2);
    layer.add(edge, 100LL * 6 * kCell * kCell * kTalus);
    sand::tin::settle(layer, kTalus, 2 * kTalus);
    const base::Bytes rest = bytesOf(layer);
    EXPECT_EQ(sand::tin::settle(layer, kTalus, kTalus).sweeps, 1) << "the sand stopped above the threshold";
    EXPECT_EQ(bytesOf(layer), rest);
}

// The projection of settle() stops at the threshold by itself. Sweeps stop there because they record where sand flows.
// After 1000 sweeps some sand is still moving, so that the test allows a share of 0.02.
TEST(TinErosion, SandThatSlidesInSweepsStopsAtTheThresholdWhateverTheBand) {
    for (const Kind kind : {Kind::regular, Kind::jittered}) {
        for (const double slope : {1.6, 3.0}) {
            VertexSand layer = layerOf(kind, 24);
            incline(layer, slope * kTalus, 20);
            std::vector<Vertex> moved;
            Erosion(layer, kTalus, kTalus * 3 / 2).sweep(layer, 1000, nullptr, moved);
            const std::vector<std::int64_t> volumes = layer.volumes();
            Erosion(layer, kTalus + kTalus / 50, kTalus + kTalus / 50).sweep(layer, 1, nullptr, moved);
            EXPECT_EQ(layer.volumes(), volumes) << nameOf(kind) << ", " << slope << " t";
        }
    }
}

TEST(TinErosion, WithoutAnAngleSandLevels) {
    VertexSand layer = layerOf(Kind::random, 8);
    fill(layer, [](double x, double y) { return std::hypot(x - 4, y - 4) < 2 ? 3.0 : 0.0; });
    ASSERT_TRUE(sand::tin::settle(layer, 0, 0).atRest);
    const Extremes rest = extremesOf(layer);
    EXPECT_LE(rest.highest - rest.lowest, 4 * 8) << "more than four units from cell to cell";
}

TEST(TinErosion, AtAlmostARightAngleOnlySpikesMove) {
    constexpr std::int32_t kSteep = 37'549'361;  // tangent of 89.9 degrees
    VertexSand layer = layerOf(Kind::jittered, 16);
    incline(layer, 0.99 * kSteep, 40);
    EXPECT_EQ(sand::tin::settle(layer, kSteep, kSteep).sweeps, 0) << "no triangle is too steep";
    const Vertex spike = 100;
    layer.setHeight(spike, (1 << 30) - 1);
    const sand::tin::Settled settled = sand::tin::settle(layer, kSteep, kSteep);
    EXPECT_TRUE(settled.atRest);
    EXPECT_GT(settled.sweeps, 1);
}

// 10^6 probe units of height over one probe unit of ground, on constraints. The walls have badly shaped triangles of
// every kind.
TEST(TinErosion, WallsAlmostUprightFallAndKeepTheirSand) {
    sand::tin::Mesh mesh(4096, 4096);
    const auto ring = [&mesh](std::int32_t inset) {
        const std::array<Vertex, 4> corners{mesh.insert({inset, inset}), mesh.insert({4096 - inset, inset + 7}),
                                            mesh.insert({4096 - inset - 3, 4096 - inset}),
                                            mesh.insert({inset, 4096 - inset - 5})};
        for (std::size_t i = 0; i < 4; ++i) {
            mesh.constrain(corners[i], corners[(i + 1) % 4]);
        }
        return corners;
    };
    ring(1000);
    const std::array<Vertex, 4> top = ring(1001);
    VertexSand layer(std::move(mesh));
    for (const Vertex corner : top) {
        layer.setHeight(corner, 256'000'000);
    }
    const Wide volume = layer.volume();
    const sand::tin::Settled settled = sand::tin::settle(layer, kTalus, kTalus, 100'000);
    EXPECT_TRUE(settled.atRest);
    EXPECT_TRUE(layer.volume() == volume);
    EXPECT_LE(extremesOf(layer).highest, 256'000'000);
    EXPECT_GE(extremesOf(layer).lowest, 0);
    EXPECT_LT(extremesOf(layer).highest, 200'000'000) << "the walls have not fallen";
}

TEST(TinErosion, RestingEdgesAreLeftThoughStepsAreShortAndSomethingAlwaysMoves) {
    constexpr std::uint32_t kSeed = 71;
    std::mt19937 random(kSeed);
    VertexSand layer = layerOf(Kind::jittered, 40, 0, kSeed);
    const std::vector<Vertex> all = mesh_checks::livingVertices(layer.mesh());
    for (const Vertex vertex : all) {
        layer.setHeight(vertex, static_cast<std::int32_t>(4 * kTalus * chance(random)));
    }
    static_cast<void>(layer.takeChange());
    Erosion erosion(layer, kTalus, kTalus);
    std::vector<Vertex> moved;
    std::size_t atFirst = 0;
    for (std::size_t step = 0; step < 200; ++step) {
        const Vertex pushed = all[all.size() / 2];
        layer.add(pushed, kTalus * layer.stars()[static_cast<std::size_t>(pushed)]);
        erosion.wake({pushed});
        moved.clear();
        constexpr int kSweepsInAStep = 4;
        ASSERT_EQ(erosion.sweep(layer, kSweepsInAStep, nullptr, moved), kSweepsInAStep) << "seed " << kSeed;
        ASSERT_FALSE(moved.empty()) << "step " << step << ", seed " << kSeed;
        atFirst = std::max(atFirst, erosion.activeEdges());
    }
    EXPECT_GT(atFirst, 2 * all.size()) << "only a part of the sand slid";
    EXPECT_LT(erosion.activeEdges(), atFirst / 4) << "seed " << kSeed;
}

}  // namespace
}  // namespace erosion
