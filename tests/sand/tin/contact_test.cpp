// SPDX-License-Identifier: Apache-2.0
// A tool that is held still while the sand around it sinks or rises.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "sand/tin/tool/displacement.hpp"
#include "tests/sand/tin/tool_fixture.hpp"

namespace tools {
namespace {

using namespace tin_samples;

constexpr double kRadius = 6;   // [cell]
constexpr double kDeepest = 4;  // of the tool below the level [cell]

/// A tool that has been pressed into level sand and is held there.
class HeldInTin {
public:
    explicit HeldInTin(ToolKind kind, const DetailRules& rules = fineRules())
        : tool_(toolOf(kind, kRadius), rules), layer_(levelLayer(40, 40, 512)) {
        tool_.drag(layer_, imprint_, Rim::closed, std::array{probe_});
        (void)layer_.takeChange();
    }

    Displacement::Work hold() { return tool_.hold(layer_, imprint_, Rim::closed, probe_); }
    /// Raises all sand by `cells`, which may be negative.
    void raise(double cells) {
        const auto units = static_cast<std::int64_t>(cells * sand::kUnitsPerCell);
        for (Vertex vertex = 0; vertex < static_cast<Vertex>(layer_.triangles().triangleAt.size()); ++vertex) {
            if (layer_.triangles().alive(vertex)) {
                layer_.add(vertex, units * layer_.stars()[static_cast<std::size_t>(vertex)]);
            }
        }
    }
    /// Returns how far the surface is above the underside at the centres of cells below the tool [cell].
    [[nodiscard]] double sandInTool() const {
        double most = 0;
        const auto underside = tool_.underside(probe_);
        for (std::int32_t y = 128; y < 40 * sand::kProbePerCell; y += sand::kProbePerCell) {
            for (std::int32_t x = 128; x < 40 * sand::kProbePerCell; x += sand::kProbePerCell) {
                if (underside({x, y}) < sand::TurnedShape::kFree) {
                    most = std::max(most, heightAt(layer_, {x, y}) - underside({x, y}));
                }
            }
        }
        return most / sand::kUnitsPerCell;
    }
    /// Returns the height of the highest vertex above the lowest place of the underside [cell].
    [[nodiscard]] double highestAboveTool() const {
        const auto highest = std::max_element(layer_.heights().begin(), layer_.heights().end());
        return *highest / sand::kUnitsPerCell + kDeepest;
    }
    [[nodiscard]] const Imprint& imprint() const { return imprint_; }
    [[nodiscard]] const VertexSand& layer() const { return layer_; }

private:
    Displacement tool_;
    ProbePoint probe_ = probeAt(20.3, 19.6, kRadius - kDeepest);
    VertexSand layer_;
    Imprint imprint_;
};

TEST(TinContact, AToolThatTouchesSandStaysInTheMesh) {
    for (const double sinks : {0.0, 0.06, 1.0}) {  // [cell]; beside the tool, sand stays above its underside
        HeldInTin held(ToolKind::sphere);
        held.raise(-sinks);
        const base::Bytes before = bytesOf(held.layer());
        const Imprint placed = held.imprint();
        EXPECT_TRUE(held.hold().touched.empty());
        EXPECT_EQ(bytesOf(held.layer()), before) << sinks;
        EXPECT_EQ(held.imprint(), placed) << sinks;
        EXPECT_TRUE(placed.pose);
    }
}

// A margin, because sand at rest may rise a little when the mesh changes, and the tool would come and go.
TEST(TinContact, AToolLeavesTheMeshOnlyWhenSandIsAnEighthOfACellBelow) {
    for (const ToolKind kind : {ToolKind::sphere, ToolKind::rectangle}) {
        HeldInTin held(kind);
        held.raise(-held.highestAboveTool() - 0.12);
        held.hold();
        EXPECT_TRUE(held.imprint().pose);
        held.raise(-0.01);
        held.hold();
        EXPECT_FALSE(held.imprint().pose);
    }
}

TEST(TinContact, AToolLeavesTheMeshWhenAllSandHasSunkBelowIt) {
    for (const ToolKind kind : {ToolKind::sphere, ToolKind::rectangle, ToolKind::footprint}) {
        HeldInTin held(kind);
        held.raise(-10);
        const auto volume = held.layer().volume();
        held.hold();
        EXPECT_EQ(held.imprint(), Imprint{});
        EXPECT_EQ(held.layer().volume(), volume);
        for (const sand::tin::Triangle& triangle : held.layer().triangles().triangles) {
            for (std::size_t k = 0; triangle.alive() && k < 3; ++k) {
                EXPECT_EQ(triangle.constrained[k], triangle.neighbour[k] == sand::tin::kNoNumber) << "only at the rim";
            }
        }
        const base::Bytes left = bytesOf(held.layer());
        held.hold();
        EXPECT_EQ(bytesOf(held.layer()), left);
    }
}

TEST(TinContact, SandThatComesBackIsPressedOutOnce) {
    for (const ToolKind kind : {ToolKind::sphere, ToolKind::rectangle, ToolKind::footprint}) {
        HeldInTin held(kind);
        held.raise(-10);
        held.hold();
        held.raise(10);
        const auto volume = held.layer().volume();
        EXPECT_GT(held.sandInTool(), 0.1) << "the sand has come back";
        EXPECT_FALSE(held.hold().touched.empty());
        EXPECT_TRUE(held.imprint().pose);
        EXPECT_LT(held.sandInTool(), kRadius / 15);
        EXPECT_EQ(held.layer().volume(), volume);
        EXPECT_TRUE(held.hold().touched.empty()) << "a tool in the mesh does not press again";
    }
}

TEST(TinContact, ConstraintsThatTheSceneKeepsStay) {
    DetailRules rules = fineRules();
    rules.keepsConstraints = true;
    HeldInTin held(ToolKind::sphere, rules);
    held.raise(-10);
    const base::Bytes before = bytesOf(held.layer());
    held.hold();
    EXPECT_EQ(bytesOf(held.layer()), before);
    EXPECT_TRUE(held.imprint().pose);
}

}  // namespace
}  // namespace tools
