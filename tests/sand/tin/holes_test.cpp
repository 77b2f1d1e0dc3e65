// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/geometry/holes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/tin/flow/settle.hpp"
#include "sand/tin/flow/weights.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "tests/sand/tin/mesh_checks.hpp"
#include "tests/sand/tin/tool_fixture.hpp"
#include "tests/support/sand/relaxing.hpp"

namespace holes {
namespace {

using namespace tin_samples;
using sand::Ground;
using sand::HeightField;
using sand::ProbePoint;
using sand::tin::Cells;
using sand::tin::Displacement;
using sand::tin::Holes;
using sand::tin::Imprint;
using sand::tin::TinStart;
using sand::tin::Wide;

constexpr std::int32_t kTalus = 65536;  // [unit per cell], 45 degrees

using CellTest = std::function<bool(int, int)>;

Ground wallsWhere(int columns, int rows, const CellTest& isWall) {
    Ground ground(columns, rows);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            if (isWall(column, row)) {
                ground.setWall(column, row);
            }
        }
    }
    return ground;
}

/// Returns a start with a vertex in the middle of every cell outside holes. `heightOf` returns their heights [unit].
TinStart startOf(int columns, int rows, const CellTest& isWall, const std::function<int(int, int)>& heightOf) {
    HeightField field(columns, rows, 1);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            field.setHeight(column, row, heightOf(column, row));
        }
    }
    const Ground walls = wallsWhere(columns, rows, isWall);
    return sand::tin::follow(field, &walls, {.widest = sand::kProbePerCell, .maxError = 0}).start;
}

VertexSand layerAt(const TinStart& start) {
    VertexSand layer = sand::tin::layerOf(start);
    static_cast<void>(layer.takeChange());
    return layer;
}

int levelAt(int, int) { return 1000; }

/// Whether a cell is in a ring. Some cells of the ring touch only at their corners.
bool isRing(int column, int row) {
    const double x = column - 11.5, y = row - 11.5;
    const double radius = std::sqrt(x * x + y * y);
    return radius > 6.8 && radius < 7.7;
}

/// Raises the vertex in the middle of a cell by `cells` times the side of a cell.
void lump(VertexSand& layer, int column, int row, int cells) {
    const LatticePoint at{column * 256 + 128, row * 256 + 128};
    forEachVertex(layer, [&](Vertex vertex, const LatticePoint& place, double) {
        if (place == at) {
            layer.add(vertex, layer.stars()[static_cast<std::size_t>(vertex)] * 65536 * cells);
        }
    });
}

TEST(TinHoles, AnOutlineRunsRoundTheCellsWithoutData) {
    const Cells cells = sand::tin::nominalCells(5 * 256, 4 * 256);
    const Holes holes(cells, {{1, 1, 3}, {2, 1, 2}});
    EXPECT_TRUE(holes.isHole(2, 1));
    EXPECT_FALSE(holes.isHole(2, 2));
    EXPECT_TRUE(holes.holds(LatticePoint{300, 300}));
    EXPECT_FALSE(holes.holds(LatticePoint{300, 255}));
    EXPECT_TRUE(holes.borders({256, 256}, {768, 256}));
    EXPECT_FALSE(holes.borders({256, 512}, {512, 512})) << "holes on both sides";
    EXPECT_FALSE(holes.borders({768, 256}, {1024, 256})) << "ground on both sides";
    EXPECT_EQ(holes.outline().size(), 6U);
    std::int64_t length = 0;
    for (const Holes::Part& part : holes.outline()) {
        length += std::abs(part.to.x - part.from.x) + std::abs(part.to.y - part.from.y);
    }
    EXPECT_EQ(length, 8 * 256);
    EXPECT_THROW(Holes(cells, {}), std::invalid_argument);
    EXPECT_THROW(Holes(cells, {{1, 1, 3}, {1, 3, 4}}), std::invalid_argument) << "one run that is written as two";
    EXPECT_THROW(Holes(cells, {{1, 1, 6}}), std::invalid_argument);
    EXPECT_THROW(Holes(cells, {{2, 1, 3}, {1, 1, 3}}), std::invalid_argument);
}

TEST(TinHoles, CellsThatTouchAtACornerCloseIt) {
    const Holes holes(sand::tin::nominalCells(4 * 256, 4 * 256), {{1, 1, 2}, {2, 2, 3}});
    ASSERT_TRUE(holes.isPinch(2, 2));
    EXPECT_TRUE(holes.holds(LatticePoint{500, 520}));
    EXPECT_FALSE(holes.holds(LatticePoint{470, 520}));
    const VertexSand layer = layerAt(startOf(
        4, 4, [](int c, int r) { return c == r && (c == 1 || c == 2); }, levelAt));
    const std::int64_t lost = 2 * 32 * 32;  // parts of the square around the corner that lie beside both holes
    EXPECT_TRUE(layer.ground() == Wide{6} * ((16 - 2) * 256 * 256 - lost)) << static_cast<double>(layer.ground()) / 6;
}

TEST(TinHoles, ALevelFieldWithAHoleKeepsItsSand) {
    VertexSand layer = layerAt(startOf(
        12, 9, [](int c, int r) { return c >= 3 && c < 7 && r >= 2 && r < 6; }, levelAt));
    ASSERT_EQ(mesh_checks::whatIsWrong(layer.mesh()), "");
    EXPECT_TRUE(layer.mesh().hasOutline());
    EXPECT_TRUE(layer.ground() == Wide{6} * (12 * 9 - 4 * 4) * 256 * 256);
    EXPECT_TRUE(layer.volume() == layer.ground() * 1000);
    const base::Bytes before = bytesOf(layer);
    EXPECT_TRUE(sand::tin::settle(layer, kTalus, kTalus).atRest);
    EXPECT_EQ(bytesOf(layer), before);
}

TEST(TinHoles, APileFlowsRoundAHoleAndNotIn) {
    const auto isWall = [](int c, int r) { return c >= 10 && c < 13 && r >= 6 && r < 14; };
    VertexSand layer = layerAt(startOf(24, 20, isWall, levelAt));
    lump(layer, 8, 10, 900);
    const Wide before = layer.volume();
    ASSERT_TRUE(sand::tin::settle(layer, kTalus, kTalus).atRest);
    EXPECT_TRUE(layer.volume() == before);
    EXPECT_GT(heightAt(layer, {9 * 256 + 128, 10 * 256 + 128}),
              heightAt(layer, {13 * 256 + 128, 10 * 256 + 128}) + 3 * 65536)
        << "the hole must hold the sand back: an open field would have a slope of one cell per cell";
    EXPECT_GT(heightAt(layer, {14 * 256, 15 * 256}), 1000) << "the sand must flow around the hole";
    for (const auto& triangle : layer.triangles().triangles) {
        if (triangle.hole) {
            for (const Vertex corner : triangle.corner) {
                const LatticePoint place = layer.triangles().places[static_cast<std::size_t>(corner)];
                const bool inside = place.x > 10 * 256 && place.x < 13 * 256 && place.y > 6 * 256 && place.y < 14 * 256;
                EXPECT_FALSE(inside) << "a vertex lies in the hole";
            }
        }
    }
}

TEST(TinHoles, SandInARingCannotLeave) {
    VertexSand layer = layerAt(startOf(24, 24, isRing, levelAt));
    ASSERT_EQ(mesh_checks::whatIsWrong(layer.mesh()), "");
    int pinches = 0;
    for (int row = 1; row < 24; ++row) {
        for (int column = 1; column < 24; ++column) {
            pinches += layer.mesh().holes()->isPinch(column, row) ? 1 : 0;
        }
    }
    ASSERT_GT(pinches, 3) << "the ring needs corners through which sand could slip";
    // No vertex may have ground both inside and outside the ring. That includes the corners between two of its cells.
    forEachVertex(layer, [&](Vertex vertex, const LatticePoint&, double) {
        bool in = false, out = false;
        sand::tin::aroundVertex(layer.triangles(), vertex, [&](std::int32_t slot, int) {
            const auto& triangle = layer.triangles().triangles[static_cast<std::size_t>(slot)];
            for (std::size_t k = 0; k < 3 && !triangle.hole; ++k) {
                const LatticePoint& place = layer.triangles().places[static_cast<std::size_t>(triangle.corner[k])];
                const double x = place.x - 12 * 256, y = place.y - 12 * 256;
                in |= x * x + y * y < 6.5 * 256 * 6.5 * 256;
                out |= x * x + y * y > 8.6 * 256 * 8.6 * 256;
            }
        });
        EXPECT_FALSE(in && out) << "vertex " << vertex;
    });
    std::vector<double> outside;
    const auto heightsOutside = [&] {
        std::vector<double> heights;
        forEachVertex(layer, [&](Vertex, const LatticePoint& place, double height) {
            const double x = place.x - 12 * 256, y = place.y - 12 * 256;
            if (x * x + y * y > 8.3 * 256 * 8.3 * 256) {
                heights.push_back(height);
            }
        });
        return heights;
    };
    outside = heightsOutside();
    lump(layer, 12, 12, 2000);
    const Wide before = layer.volume();
    ASSERT_TRUE(sand::tin::settle(layer, kTalus, kTalus).atRest);
    EXPECT_TRUE(layer.volume() == before);
    EXPECT_EQ(heightsOutside(), outside) << "sand has left the ring";
    EXPECT_GT(heightAt(layer, {6 * 256 + 128, 12 * 256}), 65536) << "the sand must lie against the ring";
}

TEST(TinHoles, VolumeAndOutlineHoldThroughThousandsOfEdits) {
    constexpr unsigned kSeed = 29;
    constexpr int kEdits = samples::kSlowBuild ? 2000 : 10000;
    SCOPED_TRACE(fmt::format("seed {}", kSeed));
    std::mt19937 random(kSeed);
    const TinStart start = startOf(24, 24, isRing, [&](int c, int r) { return 700 * c - 300 * r; });
    VertexSand layer = layerAt(start);
    const Wide before = layer.volume(), ground = layer.ground();
    for (int edit = 0; edit < kEdits; ++edit) {
        std::string did;
        layer.edit([&](sand::tin::Mesh& mesh) { did = mesh_checks::editAtRandom(mesh, random, 900); });
        ASSERT_TRUE(layer.volume() == before) << "edit " << edit << ": " << did;
        ASSERT_TRUE(layer.ground() == ground) << "edit " << edit << ": " << did;
        if (edit % 100 == 0) {
            ASSERT_TRUE(layer.mesh().hasOutline()) << "edit " << edit << ": " << did;
        }
        if (edit % 1000 == 0) {
            ASSERT_EQ(mesh_checks::whatIsWrong(layer.mesh()), "") << "edit " << edit;
        }
    }
    EXPECT_TRUE(layer.mesh().hasOutline());
    EXPECT_EQ(mesh_checks::whatIsWrong(layer.mesh()), "");
}

TEST(TinHoles, ToolsOfAllKindsLeaveSandAndOutline) {
    constexpr unsigned kSeed = 31;
    SCOPED_TRACE(fmt::format("seed {}", kSeed));
    std::mt19937 random(kSeed);
    const auto within = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 4096) / 4096;
    };
    VertexSand layer = layerAt(startOf(24, 24, isRing, levelAt));
    const Wide before = layer.volume(), ground = layer.ground();
    std::set<LatticePoint> corners;  // of the holes; no tool may remove them
    for (const Holes::Part& part : layer.mesh().holes()->outline()) {
        corners.insert({part.from, part.to});
    }
    ASSERT_GT(corners.size(), 50U);
    Imprint imprint;
    // Lowest underside of a tool so far, and lowest height of the sand [unit].
    double deepest = levelAt(0, 0), lowest = deepest;
    for (int stroke = 0; stroke < 60; ++stroke) {
        sand::tin::DetailRules rules = fineRules();
        rules.keepsConstraints = stroke % 4 == 0;
        const auto kind = static_cast<sand::ToolKind>(stroke % sand::kToolKinds);
        const sand::Tool unturned = toolOf(kind, within(0.3, 4));
        Displacement tool(unturned.turnedTo(*sand::headingOf(within(0, 360), stroke % 2 == 0)), rules);
        const ProbePoint from = probeAt(within(2, 22), within(2, 22), within(-1, 1));
        const std::array path{from, probeAt(within(2, 22), within(2, 22), within(-1, 1))};
        (void)tool.drag(layer, imprint, sand::Rim::closed, path);
        ASSERT_TRUE(layer.volume() == before) << "stroke " << stroke;
        tool.leave(layer, imprint);
        sand::tin::settle(layer, kTalus, kTalus, 20);
        ASSERT_TRUE(layer.volume() == before && layer.ground() == ground) << "stroke " << stroke;
        ASSERT_TRUE(layer.mesh().hasOutline()) << "stroke " << stroke;
        std::set<LatticePoint> places;
        forEachVertex(layer, [&](Vertex, const LatticePoint& place, double) { places.insert(place); });
        ASSERT_TRUE(std::ranges::includes(places, corners)) << "stroke " << stroke << ": a corner of a hole is gone";
        // A tool digs down to its underside. Sand that slides makes no hole deeper than the deepest one.
        const std::int32_t underside = std::min(path[0].z, path[1].z) - unturned.radius;  // [probe unit]
        deepest = std::min(deepest, static_cast<double>(underside) * sand::kUnitsPerCell / sand::kProbePerCell);
        forEachVertex(layer, [&](Vertex vertex, const LatticePoint&, double height) {
            ASSERT_GE(height, deepest) << "stroke " << stroke << ", vertex " << vertex;
            ASSERT_GT(layer.stars()[static_cast<std::size_t>(vertex)], 0) << "vertex " << vertex << " lies in a hole";
        });
        forEachVertex(layer, [&](Vertex, const LatticePoint&, double height) { lowest = std::min(lowest, height); });
    }
    EXPECT_LT(lowest, 0.9 * deepest) << "the strokes did not dig, so that the bound shows nothing";
    EXPECT_EQ(mesh_checks::whatIsWrong(layer.mesh()), "");
}

TEST(TinHoles, ACopyOfAStateIsTheSameAndGoesOnAlike) {
    VertexSand layer = layerAt(startOf(24, 24, isRing, levelAt));
    lump(layer, 4, 12, 50);
    lump(layer, 12, 12, 300);
    sand::tin::settle(layer, kTalus, kTalus, 10);
    const base::Bytes bytes = bytesOf(layer);
    base::ByteReader reader(bytes);
    VertexSand other = VertexSand::decode(reader, layer.mesh().holes());
    EXPECT_EQ(bytesOf(other), bytes);
    EXPECT_TRUE(other.ground() == layer.ground());
    EXPECT_EQ(mesh_checks::trianglesOf(other.mesh()), mesh_checks::trianglesOf(layer.mesh()));
    sand::tin::settle(layer, kTalus, kTalus, 500);
    sand::tin::settle(other, kTalus, kTalus, 500);
    EXPECT_EQ(bytesOf(other), bytesOf(layer));
}

TEST(TinHoles, AStateWithoutTheOutlineIsRefused) {
    const VertexSand whole = levelLayer(24, 24, 256);
    const base::Bytes bytes = bytesOf(whole);
    base::ByteReader reader(bytes);
    const auto holes = startOf(24, 24, isRing, levelAt).holes;
    EXPECT_THROW((void)VertexSand::decode(reader, holes), base::FormatError);
}

TEST(TinHoles, AStartTravelsWithItsHoles) {
    const TinStart start = startOf(24, 24, isRing, levelAt);
    base::ByteWriter writer;
    start.encode(writer);
    base::ByteReader reader(writer.bytes());
    const TinStart read = TinStart::decode(reader);
    ASSERT_NE(read.holes, nullptr);
    EXPECT_EQ(read.holes->runs(), start.holes->runs());
    EXPECT_EQ(read.digest(), start.digest());
    EXPECT_EQ(bytesOf(sand::tin::layerOf(read)), bytesOf(sand::tin::layerOf(start)));
    const TinStart level = startOf(
        24, 24, [](int, int) { return false; }, levelAt);
    EXPECT_EQ(level.holes, nullptr);
    EXPECT_NE(level.digest(), start.digest());
}

// The rim is half a cell beyond the outermost cell centres. Without vertices on the rim, the ground between them
// depended on the heights of the field's corners.
TEST(TinHoles, TheRimIsAsHighAsTheCellsAlongIt) {
    HeightField field(40, 30, 1);
    for (int row = 0; row < 30; ++row) {
        for (int column = 0; column < 40; ++column) {
            const double x = column * 0.4, y = row * 0.3;
            field.setHeight(column, row, static_cast<int>(60000 * (std::sin(x) + std::cos(y))));
        }
    }
    constexpr std::int32_t kError = 6000;
    const VertexSand layer = layerAt(sand::tin::follow(field, nullptr, {.maxError = kError}).start);
    for (int column = 0; column < 40; ++column) {
        EXPECT_NEAR(heightAt(layer, {column * 256 + 128, 0}), field.height(column, 0), kError);
        EXPECT_NEAR(heightAt(layer, {column * 256 + 128, 30 * 256}), field.height(column, 29), kError);
    }
    for (int row = 0; row < 30; ++row) {
        EXPECT_NEAR(heightAt(layer, {0, row * 256 + 128}), field.height(0, row), kError);
        EXPECT_NEAR(heightAt(layer, {40 * 256, row * 256 + 128}), field.height(39, row), kError);
    }
}

}  // namespace
}  // namespace holes
