// SPDX-License-Identifier: Apache-2.0
#include "walls/orbit.hpp"

#include <gtest/gtest.h>

#include "tests/walls/sample_walls.hpp"
#include "walls/projection.hpp"

namespace walls {
namespace {

const Stage kTurnedStage{{0.1, 1, -0.2}, 2, 35, 10};

glm::dvec3 placed(const Orbit& orbit, glm::dvec3 place) {
    return glm::dvec3(stageToRoom(kTurnedStage, 4, 2, 0.5, orbit) * glm::dvec4(place, 1));
}

void expectPlaced(glm::dvec3 got, glm::dvec3 want) {
    EXPECT_LT(glm::distance(got, want), 1e-12) << got.x << ", " << got.y << ", " << got.z;
}

TEST(Orbit, IsReadFromItsText) {
    for (const Orbit& orbit : {Orbit{}, Orbit{-12.5, 1.0 / 3, 0.017, {1e-9, -2, 3.25}}, Orbit{180, -30, 64, {}}}) {
        EXPECT_EQ(Orbit::parse(orbit.text(), "--view"), orbit) << orbit.text();
    }
    EXPECT_EQ(Orbit{}.text(), "1,0,0,0,0,0");
}

TEST(Orbit, RefusesATextThatIsNoView) {
    for (const char* text : {"", "1", "1,0,0,0,0", "1,0,0,0,0,0,0", "0,0,0,0,0,0", "-1,0,0,0,0,0", "1,0,0,0,0,x",
                             "1,0,nan,0,0,0", "1,inf,0,0,0,0", "1;0;0;0;0;0", "1, 0,0,0,0,0", "1,0,0,0,0,"}) {
        try {
            (void)Orbit::parse(text, "--view");
            ADD_FAILURE() << text;
        } catch (const base::InputError& error) {
            EXPECT_EQ(std::string(error.what()).find(std::string("--view: '") + text + "' must be ZOOM,"), 0U);
        }
    }
}

TEST(Orbit, WithoutADragIsTheStage) {
    for (const glm::dvec3 place : {glm::dvec3(0), glm::dvec3(4, 2, 1), glm::dvec3(1, 2, 3)}) {
        expectPlaced(placed({}, place), glm::dvec3(stageToRoom(kTurnedStage, 4, 2, 0.5) * glm::dvec4(place, 1)));
    }
}

TEST(Orbit, TurnsTheSandAboutItsOwnVerticalThroughItsCentre) {
    expectPlaced(placed({90, 0}, {2, 1, 0.5}), kTurnedStage.centre);
    expectPlaced(placed({90, 0}, {3, 1, 0.5}), placed({}, {2, 2, 0.5}));  // east goes to where north was
    expectPlaced(placed({180, 0}, {0, 0, 0.7}), placed({}, {4, 2, 0.7}));
}

TEST(Orbit, TiltsAsTheStageDoes) {
    Stage tilted = kTurnedStage;
    tilted.tiltDegrees += 20;
    expectPlaced(placed({0, 20}, {3, 2, 1}), glm::dvec3(stageToRoom(tilted, 4, 2, 0.5) * glm::dvec4(3, 2, 1, 1)));
}

TEST(Orbit, ADragTurnsAndTiltsWithinLimits) {
    const Orbit once = Orbit{}.dragged(kTurnedStage, 0.5, 0.1);
    EXPECT_NEAR(once.turnDegrees, 90, 1e-12);
    EXPECT_NEAR(once.tiltDegrees, 9, 1e-12);
    const Orbit round = once.dragged(kTurnedStage, 1.5, 100);
    EXPECT_NEAR(round.turnDegrees, 0, 1e-12);
    EXPECT_NEAR(round.tiltDegrees, Orbit::kHighest - 35, 1e-12);
    EXPECT_NEAR(round.dragged(kTurnedStage, 0, -100).tiltDegrees, Orbit::kLowest - 35, 1e-12);
    const Stage level{{0, 0, 0}, 1, 0, 0};
    EXPECT_NEAR(Orbit{}.dragged(level, 0, -1).tiltDegrees, 0, 1e-12) << "the file's own tilt is below the limit";
}

TEST(Orbit, IsForDesktops) {
    EXPECT_TRUE(isDesktop(config("desktop.toml")));
    EXPECT_FALSE(isDesktop(config("fish_tank.toml"))) << "a tracker moves the viewer";
    EXPECT_FALSE(isDesktop(config("tiled_3x4.toml"))) << "stereo";
    EXPECT_FALSE(isDesktop(shownIn(config("flex_cave.toml"), Stereo::mono))) << "a CAVE";
}

}  // namespace
}  // namespace walls
