// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/tool/displacement.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/sand/tin/tool_fixture.hpp"

namespace tools {
namespace {

using namespace tin_samples;

constexpr double kCell = sand::kUnitsPerCell;

Displacement::Work press(VertexSand& layer, Imprint& imprint, Displacement& tool, const ProbePoint& probe,
                         Rim rim = Rim::closed) {
    return tool.drag(layer, imprint, rim, std::array{probe});
}

double lowest(const VertexSand& layer) {
    double result = 0;
    forEachVertex(layer, [&](Vertex, const LatticePoint&, double height) { result = std::min(result, height); });
    return result;
}

/// Expects that no vertex below the tool is above its underside.
void expectClear(const VertexSand& layer, const Displacement& tool, const ProbePoint& probe) {
    const auto underside = tool.underside(probe);
    forEachVertex(layer, [&](Vertex vertex, const LatticePoint& place, double height) {
        EXPECT_LE(height, underside(place)) << "vertex " << vertex;
    });
}

TEST(TinTool, VolumeIsExactAfterRandomStrokesOfAllTools) {
    constexpr unsigned kSeed = 7;
    std::mt19937 random(kSeed);
    SCOPED_TRACE(fmt::format("seed {}", kSeed));
    const auto within = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 4096) / 4096;
    };
    for (const Rim rim : {Rim::closed, Rim::open}) {
        VertexSand layer = levelLayer(40, 30, 512);
        Imprint imprint;
        sand::tin::Volume outflow = 0;
        const sand::tin::Volume before = layer.volume();
        for (int stroke = 0; stroke < 36; ++stroke) {
            DetailRules rules = fineRules();
            rules.keepsConstraints = stroke % 3 == 0;
            const auto kind = static_cast<ToolKind>(stroke % sand::kToolKinds);
            Displacement tool(toolOf(kind, within(0.2, 8), *sand::headingOf(within(0, 360), stroke % 2 == 0)), rules);
            std::vector<ProbePoint> path{probeAt(within(-3, 43), within(-3, 33), within(-1, 3))};
            for (int point = 0; point < 3; ++point) {
                const ProbePoint last = path.back();
                path.push_back({last.x + static_cast<std::int32_t>(within(-900, 900)),
                                last.y + static_cast<std::int32_t>(within(-900, 900)),
                                last.z + static_cast<std::int32_t>(within(-200, 200))});
                const Displacement::Work done = tool.drag(layer, imprint, rim, std::array{last, path.back()});
                outflow += done.outflow;
                ASSERT_TRUE(layer.volume() + outflow == before) << "stroke " << stroke;
                EXPECT_TRUE(std::is_sorted(done.touched.begin(), done.touched.end()));
            }
            tool.leave(layer, imprint);
            ASSERT_TRUE(layer.volume() + outflow == before) << "stroke " << stroke;
        }
        EXPECT_EQ(outflow > 0, rim == Rim::open);
    }
}

TEST(TinTool, ThreeEllipsesLeaveTheirDepthAndConstrainedOutlines) {
    VertexSand layer = levelLayer(60, 40, 512);
    DetailRules rules = fineRules();
    rules.keepsConstraints = true;
    const sand::Tool ellipse = toolOf(ToolKind::ellipse, 8);
    const std::array<std::pair<ProbePoint, double>, 3> poses{
        {{probeAt(12, 12, 6), 20}, {probeAt(30, 27, 6.5), -40}, {probeAt(46, 12, 7), 75}}};
    Imprint imprint;
    for (const auto& [at, degrees] : poses) {
        Displacement tool(ellipse.turnedTo(*sand::headingOf(degrees)), rules);
        press(layer, imprint, tool, at);
        expectClear(layer, tool, at);
        tool.leave(layer, imprint);
    }
    EXPECT_EQ(layer.mesh().constraints().size(), 3U * 32);
    for (const auto& [at, degrees] : poses) {
        const sand::Tool turned = ellipse.turnedTo(*sand::headingOf(degrees));
        const double depth = (at.z - turned.radius) * 256.0;
        int inside = 0;
        forEachVertex(layer, [&, tool = at](Vertex vertex, const LatticePoint& place, double height) {
            if (sand::TurnedShape(turned).covers({place.x - tool.x, place.y - tool.y})) {
                EXPECT_EQ(height, depth) << "vertex " << vertex;
                ++inside;
            }
        });
        EXPECT_GT(inside, 32 + 60);
        const auto outline = sand::tin::placed(sand::tin::Outline::of(turned), at.x, at.y, layer.triangles());
        for (const auto& [from, to] : outline.edges) {
            const auto vertexAt = [&](const LatticePoint& wanted) {
                Vertex found = sand::tin::kNoNumber;
                forEachVertex(layer, [&](Vertex vertex, const LatticePoint& place, double) {
                    found = place == wanted ? vertex : found;
                });
                return found;
            };
            EXPECT_TRUE(layer.mesh().isConstrained(vertexAt(from), vertexAt(to)));
        }
    }
}

/// Returns the total length of all constraints [cell].
double lengthOfConstraints(const VertexSand& layer) {
    double length = 0;
    for (const auto& [a, b] : layer.mesh().constraints()) {
        const LatticePoint &from = layer.triangles().places[sand::tin::index(a)],
                           &to = layer.triangles().places[sand::tin::index(b)];
        length += std::hypot(to.x - from.x, to.y - from.y) / sand::kProbePerCell;
    }
    return length;
}

// The points of the second stamp lie on the edges of the first one, and its edges lie along them. Points and edges
// that the second stamp adds must go with it. Those of the first stamp must stay.
TEST(TinTool, DraggedAwayItLeavesTheEarlierOutlineItStoodOn) {
    VertexSand layer = levelLayer(60, 40, 256);
    DetailRules rules = fineRules();
    rules.keepsConstraints = true;
    Displacement tool(toolOf(ToolKind::rectangle, 4), rules);
    Imprint imprint;
    press(layer, imprint, tool, probeAt(15, 20, 3.5));
    tool.leave(layer, imprint);
    const double once = lengthOfConstraints(layer);
    EXPECT_EQ(layer.mesh().constraints().size(), 32U);
    double far = 30;
    for (const auto& [x, y] : {std::pair{4.0, 0.0}, {0.3, 0.0}, {3.7, 2.1}}) {
        tool.drag(layer, imprint, Rim::closed, std::array{probeAt(15 + x, 20 + y, 3.5)});
        tool.drag(layer, imprint, Rim::closed, std::array{probeAt(15 + x, 20 + y, 3.5), probeAt(far, 20, 3.5)});
        tool.leave(layer, imprint);
        EXPECT_NEAR(lengthOfConstraints(layer), (far / 10 - 1) * once, 0.01) << "stamped at " << x << ", " << y;
        far += 10;
    }
}

TEST(TinTool, LiftedItsOutlineDissolvesUnlessTheSceneKeepsIt) {
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        VertexSand layer = levelLayer(40, 30, 256);
        Displacement tool(toolOf(static_cast<ToolKind>(kind), 7, *sand::headingOf(31)), fineRules());
        Imprint imprint;
        const auto before = layer.volume();
        const ProbePoint probe = probeAt(20, 15, 6);
        press(layer, imprint, tool, probe);
        EXPECT_FALSE(layer.mesh().constraints().empty());
        EXPECT_FALSE(imprint.points.empty());
        const double deep = lowest(layer);
        tool.leave(layer, imprint);
        EXPECT_TRUE(layer.mesh().constraints().empty());
        EXPECT_EQ(imprint, Imprint{});
        EXPECT_TRUE(layer.volume() == before);
        EXPECT_NEAR(lowest(layer), deep, 0.2 * kCell) << base::nameOf(static_cast<ToolKind>(kind));
    }
}

TEST(TinTool, HeldStillItChangesNothing) {
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        VertexSand layer = levelLayer(40, 30, 256);
        Displacement tool(toolOf(static_cast<ToolKind>(kind), 6, *sand::headingOf(31)), fineRules());
        Imprint imprint;
        const ProbePoint from = probeAt(18, 14, 5), to = probeAt(20, 15.5, 4.5);
        tool.drag(layer, imprint, Rim::closed, std::array{from, to});
        static_cast<void>(layer.takeChange());
        const base::Bytes before = bytesOf(layer);
        const Imprint placed = imprint;
        for (int step = 0; step < 3; ++step) {
            const Displacement::Work done = tool.drag(layer, imprint, Rim::closed, std::array{to, to});
            EXPECT_TRUE(done.touched.empty());
        }
        EXPECT_EQ(bytesOf(layer), before);
        EXPECT_EQ(imprint, placed);
        EXPECT_TRUE(layer.takeChange().vertices.empty());
    }
}

TEST(TinTool, PushesSandAheadAndToTheSidesAndNotBehind) {
    VertexSand layer = levelLayer(60, 40, 256);
    Displacement tool(toolOf(ToolKind::sphere, 5), fineRules());
    Imprint imprint;
    const ProbePoint from = probeAt(20, 20, 4), to = probeAt(35, 20, 4);
    tool.drag(layer, imprint, Rim::closed, std::array{from, to});
    expectClear(layer, tool, to);
    double ahead = 0, behind = 0;
    forEachVertex(layer, [&](Vertex vertex, const LatticePoint& place, double height) {
        const double above =
            std::max(height, 0.0) * static_cast<double>(layer.stars()[static_cast<std::size_t>(vertex)]);
        ahead += place.x > to.x ? above : 0;
        behind += place.x < from.x ? above : 0;
    });
    EXPECT_GT(ahead, 20 * behind);
    for (double x = 21; x < 35; x += 0.5) {  // the groove is as deep as the underside along its middle
        EXPECT_NEAR(heightAt(layer, {static_cast<std::int32_t>(x * 256), 20 * 256}), -kCell, 0.25 * kCell) << x;
    }
}

TEST(TinTool, OutsideOrAboveTheSandItLeavesTheLayerAlone) {
    VertexSand layer = levelLayer(30, 30, 256);
    const base::Bytes before = bytesOf(layer);
    Imprint imprint;
    Displacement tool(toolOf(ToolKind::ellipsoid, 4), fineRules());
    const std::array<ProbePoint, 4> poses{probeAt(-20, 15, 0), probeAt(60, 60, -10), probeAt(15, 15, 4.5),
                                          ProbePoint{sand::kMaxProbe, -sand::kMaxProbe, -sand::kMaxProbe}};
    for (const ProbePoint& probe : poses) {
        EXPECT_TRUE(press(layer, imprint, tool, probe).touched.empty());
    }
    tool.leave(layer, imprint);
    EXPECT_EQ(bytesOf(layer), before);
}

TEST(TinTool, OfRadiusZeroItDoesNothing) {
    VertexSand layer = levelLayer(20, 20, 256);
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        Displacement tool({static_cast<ToolKind>(kind), 0, 0}, DetailRules{});
        Imprint imprint;
        const auto before = layer.volumes();
        EXPECT_TRUE(press(layer, imprint, tool, probeAt(10.5, 10.5, -3)).touched.empty());
        EXPECT_EQ(layer.volumes(), before);
    }
}

TEST(TinTool, LargerThanTheFieldItLeavesTheSandWhereItIs) {
    VertexSand layer = levelLayer(12, 8, 256);
    const auto before = layer.volume();
    Displacement tool(toolOf(ToolKind::circle, 40), fineRules());
    Imprint imprint;
    const Displacement::Work done = press(layer, imprint, tool, probeAt(6, 4, 30));
    EXPECT_TRUE(done.touched.empty());
    EXPECT_TRUE(layer.volume() == before);
    forEachVertex(layer, [](Vertex, const LatticePoint&, double height) { EXPECT_EQ(height, 0); });
    const Displacement::Work spilt = press(layer, imprint, tool, probeAt(6, 4, 30), Rim::open);
    EXPECT_TRUE(spilt.outflow > 0);
    EXPECT_TRUE(layer.volume() + spilt.outflow == before);
    forEachVertex(layer, [](Vertex, const LatticePoint&, double height) { EXPECT_EQ(height, -10 * kCell); });
}

TEST(TinTool, AtACornerTheOpenRimSwallowsAndTheClosedOneKeeps) {
    for (const Rim rim : {Rim::closed, Rim::open}) {
        VertexSand layer = levelLayer(30, 30, 256);
        Displacement tool(toolOf(ToolKind::sphere, 4), fineRules());
        Imprint imprint;
        const auto before = layer.volume();
        const ProbePoint probe = probeAt(0, 0, 2);
        const Displacement::Work done = press(layer, imprint, tool, probe, rim);
        expectClear(layer, tool, probe);
        EXPECT_TRUE(layer.volume() + done.outflow == before);
        // Each vertex of the ring takes sand in proportion to its star. A quarter of the ring lies in the field.
        double kept = 0, stars = 0;
        forEachVertex(layer, [&](Vertex vertex, const LatticePoint&, double height) {
            const auto star = static_cast<double>(layer.stars()[static_cast<std::size_t>(vertex)]);
            kept += std::max(height, 0.0) * star;
            stars += height > 0 ? star : 0;
        });
        // The ring is two cells wide. The ground beyond counts as a lattice of one vertex per cell. Each of its stars
        // is six triangles of half a square with the weight two, so that it is six squares.
        int squares = 0;  // of the ring in one quadrant
        for (double y = 0.5; y < 6; ++y) {
            for (double x = 0.5; x < 6; ++x) {
                squares += x * x + y * y >= 4 * 4 && x * x + y * y <= 6 * 6 ? 1 : 0;
            }
        }
        EXPECT_EQ(squares, 15) << "of an area of 15.7 squares";
        const double beyond = 3.0 * squares * 6 * sand::kProbePerCell * sand::kProbePerCell;
        EXPECT_NEAR(static_cast<double>(done.outflow) / kept, rim == Rim::open ? beyond / stars : 0, 1e-9);
        tool.leave(layer, imprint);
        EXPECT_TRUE(layer.volume() + done.outflow == before);
        EXPECT_TRUE(layer.mesh().constraints().empty());
    }
}

TEST(TinTool, TeleportingItSweepsTheWholeWay) {
    VertexSand layer = levelLayer(120, 120, 1024);
    Displacement tool(toolOf(ToolKind::circle, 3), fineRules());
    Imprint imprint;
    const auto before = layer.volume();
    tool.drag(layer, imprint, Rim::closed, std::array{probeAt(5, 5, 1), probeAt(115, 115, 1)});
    EXPECT_TRUE(layer.volume() == before);
    for (double way = 8; way <= 112; way += 1) {
        const auto at = static_cast<std::int32_t>(way * 256);
        EXPECT_LT(heightAt(layer, {at, at}), -1.5 * kCell) << way;
    }
}

TEST(TinTool, GoesOnTheSameFromARestoredLayer) {
    VertexSand layer = levelLayer(40, 30, 512);
    Imprint imprint;
    Displacement tool(toolOf(ToolKind::footprint, 8, *sand::headingOf(25)), fineRules());
    for (int step = 0; step < 4; ++step) {
        tool.drag(layer, imprint, Rim::open,
                  std::array{probeAt(12 + step, 12, 7.5), probeAt(13 + step, 12 + step, 7.2)});
    }
    const auto restore = [&] {
        base::ByteWriter writer;
        layer.encode(writer);
        imprint.encode(writer);
        base::ByteReader reader(writer.bytes());
        VertexSand other = VertexSand::decode(reader);
        return std::pair(std::move(other), Imprint::decode(reader));
    };
    auto [otherLayer, otherImprint] = restore();
    EXPECT_EQ(otherImprint, imprint);
    Displacement other(toolOf(ToolKind::footprint, 8, *sand::headingOf(25)), fineRules());
    for (int step = 0; step < 6; ++step) {
        const std::array path{probeAt(17 + step, 13, 7.2), probeAt(18 + step, 14, 7.1)};
        const Displacement::Work one = tool.drag(layer, imprint, Rim::open, path);
        const Displacement::Work two = other.drag(otherLayer, otherImprint, Rim::open, path);
        ASSERT_EQ(one.touched, two.touched) << "step " << step;
        ASSERT_EQ(bytesOf(layer), bytesOf(otherLayer)) << "step " << step;
        ASSERT_EQ(imprint, otherImprint);
    }
    tool.leave(layer, imprint);
    other.leave(otherLayer, otherImprint);
    EXPECT_EQ(bytesOf(layer), bytesOf(otherLayer));
}

TEST(TinTool, KeepsTheBudgetOfVertices) {
    VertexSand layer = levelLayer(60, 60, 1024);
    DetailRules rules = fineRules();
    rules.maxVertices = layer.mesh().vertexCount() + 150;
    Displacement tool(toolOf(ToolKind::ellipsoid, 6, *sand::headingOf(40)), rules);
    Imprint imprint;
    const auto before = layer.volume();
    int most = 0;
    for (int step = 0; step < 20; ++step) {
        tool.drag(layer, imprint, Rim::closed,
                  std::array{probeAt(10 + 2 * step, 30, 5), probeAt(12 + 2 * step, 30, 5)});
        most = std::max(most, layer.mesh().vertexCount());
        ASSERT_LE(layer.mesh().vertexCount(), rules.maxVertices);
    }
    EXPECT_EQ(most, rules.maxVertices);
    EXPECT_TRUE(layer.volume() == before);
}

TEST(TinTool, ACoarseMeshWithoutDetailTakesTheImprint) {
    sand::tin::Mesh bare(40 * 256, 40 * 256);
    VertexSand layer(std::move(bare));
    Displacement tool(toolOf(ToolKind::rectangle, 5, *sand::headingOf(10)), DetailRules{});
    Imprint imprint;
    const auto before = layer.volume();
    const ProbePoint probe = probeAt(20, 20, 4);
    const Displacement::Work done = press(layer, imprint, tool, probe);
    EXPECT_EQ(done.touched.size(), 36U);  // 32 control points and the field's corners
    EXPECT_EQ(layer.mesh().constraints().size(), 32U);
    expectClear(layer, tool, probe);
    EXPECT_TRUE(layer.volume() == before);
}

TEST(TinTool, RefusesADamagedImprint) {
    VertexSand layer = levelLayer(20, 20, 512);
    Imprint imprint;
    Displacement tool(toolOf(ToolKind::sphere, 4), fineRules());
    press(layer, imprint, tool, probeAt(10, 10, 3));
    base::ByteWriter writer;
    imprint.encode(writer);
    const base::Bytes whole = writer.take();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        base::ByteReader reader(std::span<const std::uint8_t>(whole).first(length));
        EXPECT_THROW(Imprint::decode(reader), base::FormatError) << length;
    }
    imprint.edges.assign(5000, {7, 9});  // as for a large tool across the outlines of many small ones
    base::ByteWriter many;
    imprint.encode(many);
    base::ByteReader manyReader(many.bytes());
    EXPECT_EQ(Imprint::decode(manyReader).edges.size(), 5000U);
    base::Bytes other = whole;
    other[13] = 99;  // the kind of the tool
    base::ByteReader reader(other);
    EXPECT_THROW(Imprint::decode(reader), base::FormatError);
}

}  // namespace
}  // namespace tools
