// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <numbers>

#include "tests/tracking/tracking_samples.hpp"
#include "tracking/room_mapping.hpp"

namespace {

using namespace tracking;
using test::near;

const double kHalf = std::sqrt(0.5);

TEST(HeadPose, AHeadThatTurnsLeftHasItsRightEyeNearerTheWall) {
    // The wall is at -z. A viewer who faces the wall and turns left by 90 degrees has the wall on the right.
    EXPECT_TRUE(near(rotationOf(90, 0, 0)[0], {0, 0, -1}));
    EXPECT_TRUE(near(rotationOf(45, 0, 0)[0], {kHalf, 0, -kHalf}));
    EXPECT_TRUE(near(rotationOf(-45, 0, 0)[0], {kHalf, 0, kHalf}));
}

TEST(HeadPose, AHeadThatLooksUpSeesUp) {
    // The head looks along minus its third axis. Its eyes stay level.
    EXPECT_TRUE(near(-rotationOf(0, 30, 0)[2], {0, 0.5, -std::sqrt(0.75)}));
    EXPECT_TRUE(near(rotationOf(0, 30, 0)[0], {1, 0, 0}));
}

TEST(HeadPose, AHeadThatTiltsLeftHasItsRightEyeHigher) {
    EXPECT_TRUE(near(rotationOf(0, 0, 30)[0], {std::sqrt(0.75), 0.5, 0}));
}

TEST(HeadPose, RollComesBeforePitchBeforeYaw) {
    // After a roll of 90 degrees the right eye is on top. Looking up by 90 degrees moves it backwards. Turning left by
    // 90 degrees moves it to +x.
    EXPECT_TRUE(near(rotationOf(0, 0, 90)[0], {0, 1, 0}));
    EXPECT_TRUE(near(rotationOf(0, 90, 90)[0], {0, 0, 1}));
    EXPECT_TRUE(near(rotationOf(90, 90, 90)[0], {1, 0, 0}));
}

TEST(HeadPose, WhatIsAbsurdIsNotPlausible) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(plausible({{kFarthest, -kFarthest, 0}}));
    EXPECT_FALSE(plausible({{kFarthest * 1.0001, 0, 0}}));
    EXPECT_FALSE(plausible({{0, nan, 0}}));
    EXPECT_FALSE(plausible({{0, 0, -infinite}}));
    EXPECT_TRUE(plausible({{0, 0, 0}, rotationOf(10, 20, 30)}));
    EXPECT_FALSE(plausible({{0, 0, 0}, glm::dmat3(0.0)})) << "a body that is not seen";
    EXPECT_FALSE(plausible({{0, 0, 0}, glm::dmat3(nan)}));
    EXPECT_FALSE(plausible({{0, 0, 0}, glm::dmat3(1.1)})) << "scaled";
    EXPECT_FALSE(plausible({{0, 0, 0}, glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1)})) << "mirrored";
}

TEST(RoomMapping, PutsTheOriginWhereTheTrackerStands) {
    const Pose pose = RoomMapping{{1, 2, 3}}.pose({{0.1, 0.2, 0.3}});
    EXPECT_TRUE(near(pose.position, {1.1, 2.2, 3.3}));
    EXPECT_EQ(pose.right, glm::dvec3(1, 0, 0));
}

TEST(RoomMapping, TurnsATrackerWhoseZIsUp) {
    // The tracker's y points from the viewer into the wall.
    RoomMapping mapping;
    mapping.axes = axesOf("x,z,-y").value();
    EXPECT_TRUE(near(mapping.pose({{1, 2, 3}}).position, {1, 3, -2}));
    // A turn to the left is a turn about the tracker's z.
    const double angle = std::numbers::pi / 4;
    const glm::dmat3 left(std::cos(angle), std::sin(angle), 0, -std::sin(angle), std::cos(angle), 0, 0, 0, 1);
    EXPECT_TRUE(near(mapping.pose({{0, 0, 0}, left}).right, {kHalf, 0, -kHalf}));
}

TEST(RoomMapping, MirrorsPlaceAndTurnAlike) {
    RoomMapping mapping;
    mapping.axes = axesOf("-x,y,z").value();
    const Pose pose = mapping.pose({{0.3, 0, 0}, rotationOf(45, 0, 0)});
    EXPECT_TRUE(near(pose.position, {-0.3, 0, 0}));
    EXPECT_TRUE(near(pose.right, {kHalf, 0, kHalf})) << "left has become right";
}

TEST(RoomMapping, FindsTheEyesBesideWhatIsTracked) {
    // The target is on the forehead. The eyes are 10 cm below it and 2 cm behind it in every direction of the head.
    const RoomMapping mapping{{0, 0, 0}, glm::dmat3(1.0), {0, -0.10, 0.02}};
    EXPECT_TRUE(near(mapping.pose({{0, 2, 0}}).position, {0, 1.90, 0.02}));
    EXPECT_TRUE(near(mapping.pose({{0, 2, 0}, rotationOf(90, 0, 0)}).position, {0.02, 1.90, 0}));
}

TEST(RoomMapping, ReadsAxesOnlyWhenEachIsNamedOnce) {
    EXPECT_EQ(axesOf("x,y,z"), glm::dmat3(1.0));
    EXPECT_EQ(axesOf("+x, y ,z"), glm::dmat3(1.0));
    for (const char* text : {"", "x,y", "x,y,z,x", "x,x,z", "x,y,w", "x,y,--z", "x,y,", "xyz", "X,y,z"}) {
        EXPECT_FALSE(axesOf(text)) << text;
    }
}

}  // namespace
