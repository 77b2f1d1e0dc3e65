// SPDX-License-Identifier: Apache-2.0
// Tools that are held in corners, half outside the field, and over walls, holes and rock while the sand settles.
#include <gtest/gtest.h>

#include "tests/support/held_tools.hpp"

namespace {

using borders::HeldAt;
using borders::kGrid;
using borders::kSide;
using borders::kTin;
using enum sand::ToolKind;

void expectNoSandIn(const borders::Ground& ground, sand::ToolKind kind, HeldAt place, double most) {
    const borders::HeldSettle held = borders::settleAround(ground, kSide, kind, place);
    const std::string name = std::string(base::nameOf(kind)) + ", " + borders::nameOf(place);
    EXPECT_LE(held.largest, most) << name;
    EXPECT_EQ(held.changed, 0) << name;
    EXPECT_EQ(held.exchanged, 0) << name;
    EXPECT_TRUE(held.still) << name;
}

TEST(HeldTool, OfAGridKeepsAllSandOutWhileItSettles) {
    for (const sand::ToolKind kind : {sphere, circle, rectangle, ellipse, ellipsoid, footprint}) {
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

}  // namespace
