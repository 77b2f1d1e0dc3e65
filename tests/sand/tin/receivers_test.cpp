// SPDX-License-Identifier: Apache-2.0
// A tool shares out the sand that it displaces among the vertices around it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "tests/sand/tin/tool_fixture.hpp"

namespace tin_receivers {
namespace {

using namespace tin_samples;
using sand::Offset;
using sand::TurnedShape;

/// A tool on level sand whose mesh has the tool's outline, and the shares that its receivers get.
struct Pressed {
    VertexSand layer = levelLayer(60, 60, 200);
    TurnedShape shape;
    ProbePoint probe = probeAt(30.3, 29.6, 2);
    std::map<Vertex, std::int64_t> expected;
    std::int64_t remainder = 0;  // units that could not be shared evenly

    Pressed(const sand::Tool& tool, const ProbePoint& way) : shape(tool) {
        sand::tin::Displacement displacement(tool, fineRules());
        Imprint imprint;
        const ProbePoint from{probe.x - way.x, probe.y - way.y, probe.z};
        if (way == ProbePoint{}) {
            displacement.drag(layer, imprint, Rim::closed, std::array{probe});
        } else {
            displacement.drag(layer, imprint, Rim::closed, std::array{from, probe});
        }
        share(way);
    }
    [[nodiscard]] std::int64_t volume(Vertex vertex) const { return layer.volumes()[static_cast<std::size_t>(vertex)]; }

private:
    /// Derives the shares. A vertex beside the tool takes sand in proportion to its star. If the tool is dragged by
    /// `way`, the share also grows with the distance ahead of the tool. Rounding towards zero leaves a rest. It is
    /// shared evenly, and its last units go to the vertices with the smallest numbers.
    void share(const ProbePoint& way) {
        std::map<Vertex, double> weights;
        std::int64_t taken = 0;
        double total = 0;
        forEachVertex(layer, [&](Vertex vertex, const LatticePoint& place, double) {
            taken -= std::min<std::int64_t>(volume(vertex), 0);
            const Offset offset{std::int64_t{place.x} - probe.x, std::int64_t{place.y} - probe.y};
            const std::int64_t part = way == ProbePoint{} ? 1 : shape.share(offset, {way.x, way.y});
            if (shape.takes(offset) && !shape.covers(offset) && part > 0) {
                weights[vertex] =
                    static_cast<double>(part) * static_cast<double>(layer.stars()[static_cast<std::size_t>(vertex)]);
                total += weights[vertex];
            }
        });
        std::int64_t rest = taken;
        for (const auto& [vertex, weight] : weights) {
            expected[vertex] = static_cast<std::int64_t>(static_cast<double>(taken) / total * weight);
            rest -= expected[vertex];
        }
        const auto count = static_cast<std::int64_t>(weights.size());
        const std::int64_t each = rest / count - (rest % count < 0 ? 1 : 0);
        rest -= each * count;
        remainder = rest;
        for (auto& [vertex, volume] : expected) {
            volume += each + (rest-- > 0 ? 1 : 0);
        }
    }
};

void expectShares(const Pressed& pressed) {
    ASSERT_GT(pressed.expected.size(), 50U);
    forEachVertex(pressed.layer, [&](Vertex vertex, const LatticePoint& place, double) {
        const auto found = pressed.expected.find(vertex);
        const std::int64_t expected = found == pressed.expected.end() ? 0 : found->second;
        ASSERT_EQ(std::max<std::int64_t>(pressed.volume(vertex), 0), expected)
            << "vertex " << vertex << " at " << place.x << ", " << place.y;
    });
}

TEST(TinReceivers, TheRemainderGoesToTheVerticesWithTheSmallestNumbersOneUnitEach) {
    int remainders = 0;
    for (const ToolKind kind : {ToolKind::sphere, ToolKind::circle, ToolKind::ellipse, ToolKind::footprint}) {
        const Pressed pressed(toolOf(kind, 12, *sand::headingOf(30)), {});
        SCOPED_TRACE(std::string(base::nameOf(kind)));
        expectShares(pressed);
        remainders += pressed.remainder > 1 ? 1 : 0;
    }
    EXPECT_GT(remainders, 2) << "without remainders the test proves nothing";
}

TEST(TinReceivers, ASlowDragPushesSandInItsOwnDirection) {
    for (const ProbePoint& way :
         {ProbePoint{40, 9, 0}, {9, 40, 0}, {-3, 200, 0}, {-90, -91, 0}, {1, 0, 0}, {2, -1, 0}}) {
        SCOPED_TRACE(testing::Message() << way.x << ", " << way.y);
        expectShares(Pressed(toolOf(ToolKind::sphere, 12), way));
    }
}

}  // namespace
}  // namespace tin_receivers
