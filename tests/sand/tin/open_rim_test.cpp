// SPDX-License-Identifier: Apache-2.0
// Sand that falls over the open rim of a TIN. The proofs hold for every sweep, and every unit is counted.
// open_table_test.cpp tests how much sand falls.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sand/model/ground.hpp"
#include "sand/tin/flow/erosion.hpp"
#include "sand/tin/flow/settle.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "tests/sand/tin/rough_layer.hpp"
#include "tests/sand/tin/tool_fixture.hpp"

namespace open_rims {
namespace {

using namespace rough_layers;
using sand::Rim;
using sand::tin::Erosion;
using sand::tin::Wide;
using tin_piles::Extremes;
using tin_piles::extremesOf;
using tin_piles::Kind;
using tin_piles::layerOf;

constexpr std::int32_t kTalus = 65536;  // [unit per cell], 45 degrees

/// Returns the height of the highest vertex on the rim [unit].
double highestOnRim(const VertexSand& layer) {
    double highest = std::numeric_limits<double>::lowest();
    for (const Vertex vertex : mesh_checks::livingVertices(layer.mesh())) {
        const auto i = static_cast<std::size_t>(vertex);
        if (isOnRim(layer.triangles(), layer.triangles().places[i])) {
            highest = std::max(highest, layer.heights()[i]);
        }
    }
    return highest;
}

/// Runs single sweeps until all sand is at rest, and checks the proofs after each.
void expectTheProofsToHold(VertexSand& layer, std::int32_t threshold, std::int32_t start, int most) {
    const Wide volume = layer.volume();
    Wide fallen = 0;
    Extremes before = extremesOf(layer);
    double energy = energyOf(layer);
    Erosion erosion(layer, threshold, start, Rim::open);
    std::vector<Vertex> moved;
    int sweep = 0;
    for (; sweep < most && !erosion.settled(); ++sweep) {
        moved.clear();
        erosion.sweep(layer, 1, nullptr, moved);
        const std::int64_t outflow = erosion.takeOutflow();
        ASSERT_GE(outflow, 0) << "sweep " << sweep;
        fallen += outflow;
        ASSERT_TRUE(layer.volume() + fallen == volume) << "sweep " << sweep;
        ASSERT_LE(highestOnRim(layer), 0) << "sweep " << sweep;
        const Extremes after = extremesOf(layer);
        // The ground beyond the rim is at height 0.
        ASSERT_GE(after.lowest, std::min(before.lowest, 0.0)) << "sweep " << sweep;
        ASSERT_LE(after.highest, before.highest) << "sweep " << sweep;
        before = after;
        const double now = energyOf(layer);
        // The energy may fall by less than a sum of doubles resolves.
        ASSERT_LE(now, energy * (1 + 1e-13)) << "sweep " << sweep;
        energy = now;
    }
    EXPECT_TRUE(erosion.settled()) << sweep << " sweeps";
    EXPECT_TRUE(fallen > 0);
}

TEST(TinOpenRim, EverySweepCountsWhatFallsAndKeepsExtremesAndLowersTheEnergy) {
    for (const std::int32_t range : {1000, 1 << 20, 1 << 28}) {
        SCOPED_TRACE(testing::Message() << "seed 11, heights within " << range);
        VertexSand layer = roughLayer(3000, 150, range, 11);
        expectTheProofsToHold(layer, kTalus / 16, kTalus / 16, 100'000);
    }
}

TEST(TinOpenRim, WithoutAnAngleAndWithABandItEndsToo) {
    for (const auto& [threshold, start] : {std::pair{0, 0}, {kTalus / 16, kTalus / 8}, {1 << 29, 1 << 29}}) {
        SCOPED_TRACE(testing::Message() << "seed 12, " << threshold << ", " << start);
        VertexSand layer = roughLayer(3000, 100, 1 << 20, 12);
        expectTheProofsToHold(layer, threshold, start, 100'000);
    }
}

TEST(TinOpenRim, SettlingCountsWhatFalls) {
    for (const Kind kind : {Kind::regular, Kind::jittered, Kind::random}) {
        VertexSand layer = layerOf(kind, 16);
        std::mt19937 random(5);
        for (const Vertex vertex : mesh_checks::livingVertices(layer.mesh())) {
            layer.setHeight(vertex, heightWithin(8 * kTalus, random));
        }
        const Wide volume = layer.volume();
        const Extremes before = extremesOf(layer);
        const auto settled = sand::tin::settle(layer, kTalus, kTalus, 1'000'000, Rim::open);
        EXPECT_TRUE(settled.atRest) << nameOf(kind);
        EXPECT_GT(settled.iterations, 0) << nameOf(kind);
        EXPECT_GT(settled.outflow, 0) << nameOf(kind);
        EXPECT_TRUE(layer.volume() + settled.outflow == volume) << nameOf(kind);
        EXPECT_LE(highestOnRim(layer), 0) << nameOf(kind);
        EXPECT_GE(extremesOf(layer).lowest, before.lowest) << nameOf(kind);
        EXPECT_LE(extremesOf(layer).highest, before.highest) << nameOf(kind);
        const base::Bytes rest = bytesOf(layer);
        const auto again = sand::tin::settle(layer, kTalus, kTalus, 1'000'000, Rim::open);
        EXPECT_EQ(bytesOf(layer), rest) << nameOf(kind) << ": sand at rest must not move";
        EXPECT_EQ(again.outflow, 0) << nameOf(kind);
    }
}

TEST(TinOpenRim, NoSandComesInFromBeyond) {
    VertexSand layer = layerOf(Kind::jittered, 16);
    tin_piles::fill(layer, [](double, double) { return -5.0; });
    const base::Bytes before = bytesOf(layer);
    const auto settled = sand::tin::settle(layer, kTalus, kTalus, 1'000'000, Rim::open);
    EXPECT_EQ(settled.outflow, 0);
    EXPECT_EQ(bytesOf(layer), before);
    // Sand from a heap in the pit may fall over the rim only after it has filled the pit there.
    tin_piles::fill(layer, [](double x, double y) { return std::hypot(x - 8, y - 8) < 3 ? 3.0 : -5.0; });
    EXPECT_EQ(sand::tin::settle(layer, kTalus, kTalus, 1'000'000, Rim::open).outflow, 0);
}

TEST(TinOpenRim, LevelSandThatLiesBelowEveryTalusFallsFromTheRim) {
    VertexSand layer = layerOf(Kind::jittered, 16);
    // The next vertex is at least a quarter of a cell from the rim. The sand is so low that the slope between them is
    // flatter than the talus.
    tin_piles::fill(layer, [](double, double) { return 0.01; });
    Erosion erosion(layer, kTalus, kTalus, Rim::open);
    std::vector<Vertex> moved;
    erosion.sweep(layer, 100, nullptr, moved);
    EXPECT_TRUE(erosion.settled());
    EXPECT_EQ(highestOnRim(layer), 0);
    EXPECT_EQ(moved.size(), 4U * 16) << "only the vertices of the rim may move";
    EXPECT_GT(erosion.takeOutflow(), 0);
    EXPECT_EQ(erosion.takeOutflow(), 0) << "takeOutflow() returns each volume once";
}

TEST(TinOpenRim, ARingOfHolesKeepsItsSandFromTheRim) {
    // A closed ring of cells without data. The sand inside never reaches the rim.
    sand::HeightField field(24, 24, 1);
    sand::Ground walls(24, 24);
    for (int row = 0; row < 24; ++row) {
        for (int column = 0; column < 24; ++column) {
            const int away = std::max(std::abs(2 * column - 23), std::abs(2 * row - 23));
            field.setHeight(column, row, 10 * kTalus);
            if (away == 13) {
                walls.setWall(column, row);
            }
        }
    }
    const auto start =
        sand::tin::follow(field, &walls, {.widest = sand::kProbePerCell, .maxError = 0}, Rim::open).start;
    VertexSand layer = sand::tin::layerOf(start);
    const Wide before = layer.volume();
    const auto settled = sand::tin::settle(layer, kTalus, kTalus, 1'000'000, Rim::open);
    EXPECT_TRUE(settled.atRest);
    EXPECT_TRUE(layer.volume() + settled.outflow == before);
    EXPECT_EQ(tin_samples::heightAt(layer, {12 * 256, 12 * 256}), 10 * kTalus);
    EXPECT_LT(tin_samples::heightAt(layer, {1 * 256, 12 * 256}), 1.1 * kTalus);
}

TEST(TinOpenRim, AToolBesideARimRefinesItOpenOrClosed) {
    for (const Rim rim : {Rim::closed, Rim::open}) {
        VertexSand layer = tin_samples::levelLayer(40, 30, 4096);
        sand::tin::Displacement tool(tin_samples::toolOf(sand::ToolKind::sphere, 4), tin_samples::fineRules());
        sand::tin::Imprint imprint;
        const std::array path{tin_samples::probeAt(20, 3, 3)};
        (void)tool.drag(layer, imprint, rim, path);
        int beside = 0;
        tin_samples::forEachVertex(layer, [&](Vertex, const sand::tin::LatticePoint& place, double) {
            beside += place.y == 0 && std::abs(place.x - 20 * 256) < 4 * 256 ? 1 : 0;
        });
        EXPECT_GE(beside, 7) << "the rim gets one vertex per cell";
        tool.leave(layer, imprint);
        EXPECT_EQ(mesh_checks::whatIsWrong(layer.mesh()), "");
    }
}

}  // namespace
}  // namespace open_rims
