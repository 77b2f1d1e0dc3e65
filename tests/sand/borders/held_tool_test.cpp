// SPDX-License-Identifier: Apache-2.0
// Tools that are held in corners, half outside the field, and over walls, holes and rock while the sand settles.
#include <gtest/gtest.h>

#include "tests/support/borders/held_tools.hpp"
#include "tests/support/borders/tool_kinds.hpp"

namespace {

using borders::HeldAt;
using borders::kGrid;
using borders::kSide;
using borders::kTin;
using enum sand::ToolKind;

void expectNoSandIn(const borders::Ground& ground, sand::ToolKind kind, HeldAt place, double most, int side = kSide) {
    const borders::HeldSettle held = borders::settleAround(ground, side, kind, place);
    const std::string name = std::string(base::nameOf(kind)) + ", " + borders::nameOf(place);
    EXPECT_LE(held.largest, most) << name;
    EXPECT_EQ(held.changed, 0) << name;
    EXPECT_EQ(held.exchanged, 0) << name;
    EXPECT_TRUE(held.atRest) << name;
    EXPECT_TRUE(held.still) << name;
}

TEST(HeldTool, OfAGridKeepsAllSandOutWhileItSettles) {
    for (const sand::ToolKind kind : support::everyTool()) {
        for (const HeldAt place : borders::kHeldAt) {
            expectNoSandIn(kGrid, kind, place, 0);
        }
    }
}

// A bowl in a mesh is made of triangles, which stand above it by less than a fifteenth of the radius.
TEST(HeldTool, OfATinKeepsAllSandOutWhileItSettles) {
    using enum HeldAt;
    for (const HeldAt place : {inCorner, outsideCorner, outsideRim, outsideOpenRim, overWall, overPocket}) {
        expectNoSandIn(kTin, sphere, place, 0.4);
        expectNoSandIn(kTin, rectangle, place, 1e-3);
        expectNoSandIn(kTin, footprint, place, 0.4);
    }
}

// On a finer mesh, more vertices are between a tool and the sand beside it. The outline of a sphere and its rings make
// slivers, along which sand must not flow without end. A toe must have enough points to keep the sand beside it out.
TEST(HeldTool, OfAFinerTinKeepsAllSandOutAndLetsItRest) {
    expectNoSandIn(kTin, sphere, HeldAt::overWall, 0.4, 2 * kSide);
    expectNoSandIn(kTin, footprint, HeldAt::overPocket, 0.4, 2 * kSide);
}

// The sand slides over an open rim, away below the tool. The outline and the rings of the tool then leave the mesh.
// Otherwise sand would run along the slivers between them for ever, and the slope behind the tool would sink.
TEST(HeldTool, OfATinLeavesASlopeAloneThatItDoesNotTouch) {
    constexpr int kFine = 3 * kSide / 2;
    for (const auto& [kind, east] : {std::pair{sphere, 64.7}, {circle, 58.0}}) {  // beyond the rim, within the field
        const borders::OpenTable lifted = borders::slideFromTool(kFine, {kind, east, 20, false});
        const borders::OpenTable held = borders::slideFromTool(kFine, {kind, east, 20, true});
        const std::string name(base::nameOf(kind));
        ASSERT_LT(lifted.missing, 2) << "only where the slopes to two rims meet";
        EXPECT_TRUE(held.atRest) << name;
        EXPECT_LT(held.missing, lifted.missing + 0.1) << name;
        EXPECT_LT(held.deepest, lifted.deepest + 0.05) << name;
    }
}

// A tool is dragged through tall sand into a corner of the field or of a pocket. Ahead of it there is ever less ground,
// so that the sand would rise there above the greatest height that sand may have. It must then go around the tool, and
// not stay above it.
TEST(HeldTool, PushesTheSandAroundThatTheCornerAheadCannotHold) {
    struct Trial {
        borders::Ground ground;
        sand::ToolKind kind;
        bool pocket;
        double height;  // of the sand [cell]
    };
    for (const Trial& trial : {Trial{kTin, ellipsoid, false, 130},
                               {kTin, ellipsoid, true, 130},
                               {kTin, sphere, true, 700},
                               {kTin, circle, true, 700},
                               {kTin, rectangle, true, 400},
                               {kGrid, sphere, false, 700},
                               {kGrid, sphere, true, 700},
                               {kGrid, circle, true, 700},
                               {kGrid, rectangle, true, 400}}) {
        borders::Case given =
            trial.pocket ? borders::walled(trial.ground, kSide, trial.kind) : borders::caseOf(trial.ground, kSide);
        given.tool = trial.kind;
        given.radius = 6;
        given.sweeps = 4;
        given.height = [&](double x, double y) { return trial.height + 4 * std::sin(x / 5) * std::cos(y / 6); };
        sand::Replica sand(borders::sceneOf(given));
        const sand::Replica before = sand;
        const double x = trial.pocket ? 48.3 : 2.3, y = trial.pocket ? 47.6 : 1.8;
        borders::Hand(sand).drag(x + 4, y + 7, x, y, 20);
        const bool bowl = trial.kind == sphere || trial.kind == ellipsoid;
        const std::string name = std::string(trial.ground.tin ? "TIN, " : "grid, ") +
                                 std::string(base::nameOf(trial.kind)) + (trial.pocket ? ", pocket" : ", corner");
        EXPECT_LE(borders::overUnderside(sand, sand.probe()), !trial.ground.tin ? 0 : bowl ? 0.4 : 1e-3) << name;
        EXPECT_EQ(sand.volume(), before.volume()) << name;
        EXPECT_EQ(borders::exchanged(before, sand), 0) << name;
    }
}

}  // namespace
