// SPDX-License-Identifier: Apache-2.0
// Inclined planes against closed rims, walls and rock faces, and the method of images, with dry, banded, humid and
// cohesive sand.
#include <gtest/gtest.h>

#include "tests/support/borders/border_planes.hpp"

namespace {

using borders::Face;
using borders::Ground;
using borders::kGrounds;
using borders::kSide;
using borders::kTin;
using borders::Sand;

/// Calls visit(ground, face, sand, name) for each kind of ground, face and sand that exists.
template <class Visit>
void forEachFace(const Visit& visit) {
    for (const Ground& ground : kGrounds) {
        for (const Face face : {Face::rim, Face::wall, Face::rock}) {
            for (const Sand& sand : borders::sands()) {
                if (!ground.tin || face != Face::rock) {  // a TIN has no rock
                    visit(ground, face, sand,
                          (ground.tin ? "TIN, " : "grid, ") + borders::nameOf(face) + ", " + sand.name);
                }
            }
        }
    }
}

TEST(BorderPlane, RestsUpToTheSlopeFromWhichSandSlides) {
    forEachFace([](const Ground& ground, Face face, const Sand& sand, const std::string& name) {
        const bool corners = !ground.tin && face == Face::wall;
        for (const double degrees : {0.0, 22.5, 45.0, 90.0, 160.0}) {
            EXPECT_EQ(borders::movedOfPlane(ground, kSide, face, sand, degrees, corners, 0.95), 0) << name << degrees;
        }
        EXPECT_GT(borders::movedOfPlane(ground, kSide, face, sand, 0, false, 1.05), 0) << name;
    });
}

// Places on the border of a hole are as high as the cells beside them. So the ground at the corner of a hole is up to
// one and a half times as steep as the plane.
TEST(BorderPlane, OfATinRestsBesideCornersOfHolesIfItIsLessSteep) {
    for (const Sand& sand : borders::sands()) {
        for (const double degrees : {0.0, 22.5, 45.0, 90.0, 160.0}) {
            EXPECT_EQ(borders::movedOfPlane(kTin, kSide, Face::wall, sand, degrees, true, 0.6), 0)
                << sand.name << degrees;
        }
    }
}

// A TIN takes a slope of up to 1.001 of the talus for the talus. Its planes take long, so that only some are tried.
TEST(BorderPlane, ThatSlidesStopsAtTheTalus) {
    forEachFace([](const Ground& ground, Face face, const Sand& sand, const std::string& name) {
        const bool cohesive = sand.material.cohesionLength > 0;
        for (const bool along : {false, true}) {
            if (!ground.tin || (cohesive ? along && face == Face::wall : sand.material.humidity > 0 && !along)) {
                EXPECT_LE(borders::errorOfSlidPlane(ground, kSide, face, sand, along), ground.tin ? 1e-3 : 1e-4)
                    << name << along;
            }
        }
    });
}

// On a grid, walls and rock faces are mirrors to the last bit. A closed rim is not, because the ground beyond it
// continues with the same slope. The meshes of half and whole differ.
TEST(BorderPlane, AndPilesMoveAtAFaceAsBesideTheirMirrorImage) {
    forEachFace([](const Ground& ground, Face face, const Sand& sand, const std::string& name) {
        const borders::Image image = borders::mirrored(ground, kSide, face, sand);
        EXPECT_GT(image.moved, 900) << name << ": too little sand moves, so that the test proves nothing";
        if (ground.tin) {
            EXPECT_LE(image.atRest, 0.3 * image.mirrorError) << name;
            EXPECT_LE(image.moving, image.mirrorError) << name;
        } else if (face == Face::rim) {
            EXPECT_LE(image.moving, 0.015 * image.moved) << name;
            EXPECT_LE(image.atRest, 0.015 * image.moved) << name;
        } else {
            EXPECT_EQ(image.moving, 0) << name;
            EXPECT_EQ(image.atRest, 0) << name;
        }
    });
}

}  // namespace
