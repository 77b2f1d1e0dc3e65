// SPDX-License-Identifier: Apache-2.0
// Sand that comes to rest at once. pile_test.cpp tests the accuracy of its piles.
#include "sand/tin/flow/settle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/byte_stream.hpp"
#include "sand/tin/flow/dual_projection.hpp"
#include "tests/support/sand/oracles.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace settling {
namespace {

using namespace tin_piles;

constexpr std::int32_t kTalus = 65536;  // [unit per cell], 45 degrees

/// Returns sand with random heights up to `roughness` [cell].
VertexSand roughLayer(Kind kind, int n, double roughness, std::uint32_t seed) {
    VertexSand layer = layerOf(kind, n, 0, seed);
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < layer.heights().size(); ++i) {
        if (layer.triangles().alive(static_cast<Vertex>(i))) {
            layer.setHeight(static_cast<Vertex>(i), static_cast<std::int32_t>(chance(random) * roughness * kHeight));
        }
    }
    return layer;
}

TEST(TinSettle, SandAtRestIsLeftAlone) {
    VertexSand layer = roughLayer(Kind::jittered, 24, 0.05, 3);
    const std::vector<std::int64_t> volumes = layer.volumes();
    const auto settled = sand::tin::settle(layer, kTalus, kTalus);
    EXPECT_TRUE(settled.atRest);
    EXPECT_EQ(settled.iterations, 0);
    EXPECT_TRUE(settled.moved.empty());
    EXPECT_EQ(layer.volumes(), volumes);
}

TEST(TinSettle, RoughSandKeepsItsVolumeAndExtremesAndNamesWhoMoved) {
    for (const Kind kind : {Kind::regular, Kind::jittered, Kind::random}) {
        for (const std::int32_t talus : {0, 20000, 200000}) {
            VertexSand layer = roughLayer(kind, 24, 40, 7);
            const sand::tin::Wide volume = layer.volume();
            const Extremes before = extremesOf(layer);
            const std::vector<std::int64_t> volumes = layer.volumes();
            const auto settled = sand::tin::settle(layer, talus, talus);
            EXPECT_TRUE(settled.atRest) << nameOf(kind) << ", " << talus;
            EXPECT_GT(settled.iterations, 0) << nameOf(kind) << ", " << talus;
            EXPECT_TRUE(layer.volume() == volume);
            EXPECT_GE(extremesOf(layer).lowest, before.lowest) << nameOf(kind) << ", " << talus;
            EXPECT_LE(extremesOf(layer).highest, before.highest) << nameOf(kind) << ", " << talus;
            std::vector<Vertex> moved;
            for (std::size_t i = 0; i < volumes.size(); ++i) {
                if (layer.volumes()[i] != volumes[i]) {
                    moved.push_back(static_cast<Vertex>(i));
                }
            }
            EXPECT_EQ(settled.moved, moved);
        }
    }
}

// The slots of triangles and their first corners are not part of the state. A restored layer has different ones.
TEST(TinSettle, DoesNotDependOnTheSlotsOfTriangles) {
    VertexSand layer = roughLayer(Kind::random, 32, 20, 11);
    for (Vertex vertex = 40; vertex < 400; vertex += 3) {
        (void)layer.remove(vertex);
    }
    base::ByteWriter writer;
    layer.encode(writer);
    base::ByteReader reader(writer.bytes());
    VertexSand again = VertexSand::decode(reader);
    const auto firsts = [](const VertexSand& one) {
        std::vector<Vertex> corners;
        for (const auto& triangle : one.triangles().triangles) {
            corners.push_back(triangle.corner[0]);
        }
        return corners;
    };
    ASSERT_NE(firsts(layer), firsts(again));
    (void)sand::tin::settle(layer, kTalus, kTalus);
    (void)sand::tin::settle(again, kTalus, kTalus);
    EXPECT_EQ(layer.volumes(), again.volumes());
}

// At first, the projection computes 34 edges around the steep triangles. The sand of this tower comes to rest twice as
// far away.
TEST(TinSettle, TheProjectionGrowsBeforeItsSand) {
    constexpr int kSide = 144;
    const oracles::Cylinder tower(8, 1200);
    VertexSand layer = layerOf(Kind::jittered, kSide);
    fill(layer, oracles::around(kSide / 2.0, kSide / 2.0, [&](double r) { return tower.start(r); }));
    sand::tin::DualProjection projection(layer, kTalus / 256.0);
    EXPECT_GT(projection.run(), 0);
    for (const auto& [vertex, gain] : projection.gains()) {
        layer.add(vertex, gain);
    }
    EXPECT_LE(misplaced(layer, oracles::around(kSide / 2.0, kSide / 2.0, [&](double r) { return tower.rest(r); })),
              0.01);
}

TEST(TinSettle, EndsAtItsLimitWithSandThatSweepsBringToRest) {
    bool ended = false;
    for (std::int64_t work = 1000; !ended; work *= 100) {
        VertexSand layer = layerOf(Kind::jittered, 24);
        fill(layer, [](double x, double) { return x < 12 ? 4096.0 : -4096.0; });
        const sand::tin::Wide volume = layer.volume();
        sand::WorkLimit limit(work);
        const auto settled = sand::tin::settle(layer, kTalus, kTalus, 1'000'000, sand::Rim::closed, &limit);
        ended = settled.atRest;
        EXPECT_TRUE(layer.volume() == volume) << work;
        const auto moves = std::count(layer.moving().begin(), layer.moving().end(), 1);
        EXPECT_TRUE(settled.atRest ? moves == 0 : moves > 0) << work << ", " << moves;
        EXPECT_TRUE(sand::tin::settle(layer, kTalus, kTalus).atRest) << work;
        EXPECT_TRUE(layer.volume() == volume) << work;
    }
}

// Only a few cells of many move. The sand beyond must not be examined twice.
TEST(TinSettle, OnlyWhatLiesAroundMovesAndNothingElse) {
    VertexSand layer = layerOf(Kind::jittered, 96);
    fill(layer, oracles::around(20, 20, [](double r) { return r < 2 ? 4.0 : 0.0; }));
    const auto settled = sand::tin::settle(layer, kTalus, kTalus);
    EXPECT_TRUE(settled.atRest);
    ASSERT_FALSE(settled.moved.empty());
    for (const Vertex vertex : settled.moved) {
        const LatticePoint& place = layer.triangles().places[static_cast<std::size_t>(vertex)];
        EXPECT_LE(std::hypot(place.x / 256.0 - 20, place.y / 256.0 - 20), 7);
    }
}

}  // namespace
}  // namespace settling
