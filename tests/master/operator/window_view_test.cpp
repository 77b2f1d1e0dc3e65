// SPDX-License-Identifier: Apache-2.0
// The view that pointers of the windows move.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <optional>

#include "base/input_error.hpp"
#include "shapes/box_outline.hpp"
#include "tests/master/operator/window_desk_fixture.hpp"
#include "walls/projection.hpp"
#include "walls/wall.hpp"

namespace {

using test::plain;

class WindowView : public test::WindowDeskTest {
protected:
    using WindowDeskTest::WindowDeskTest;
    /// Opens the desk of a desktop, whose hand is the pointer. `view` is that of a film.
    void openDesktop(const std::optional<walls::Orbit>& view = {}) {
        wall_ = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/desktop.toml");
        master::DeskOptions options;
        options.pointer = true;
        options.view = view;
        open(&force_, options);
    }
};

// The wall of these tests is in stereo, so that it is not a desktop.
TEST_F(WindowView, KeepsTheViewOfAWallThatIsNoDesktop) {
    std::array<haptic_bridge::PointerReport, 3> pointers{};
    const auto before = desk_->views().at(0).sceneToRoom;
    pointers[1].wheel = 3;
    desk_->windows().moveView(pointers);
    EXPECT_EQ(pointers[1].wheel, 0);
    EXPECT_EQ(pointers[1].depth, 3) << "the wheel is the depth";
    pointers[2].turnX = 0.25F;
    EXPECT_TRUE(desk_->windows().answers(host::monotonicNs()).empty());
    desk_->windows().moveView(pointers);
    EXPECT_EQ(answerIn(2), "this wall's view is fixed");
    pointers[2] = {.pan = {0, 0.1F, 0}};
    desk_->windows().moveView(pointers);
    EXPECT_EQ(desk_->views().at(0).sceneToRoom, before);
}

TEST_F(WindowView, MovesTheViewOfADesktopAndFramesItAgain) {
    openDesktop();
    const auto framed = desk_->views().at(0).sceneToRoom;
    const std::array<haptic_bridge::PointerReport, 3> moves{
        {{.turnX = 0.25F}, {.wheel = 1, .wheelAt = {0, 1, 0}}, {.pan = {0.1F, 0, 0}}}};
    for (const haptic_bridge::PointerReport& move : moves) {
        std::array<haptic_bridge::PointerReport, 2> pointers{haptic_bridge::PointerReport{}, move};
        const auto before = desk_->views().at(0).sceneToRoom;
        desk_->windows().moveView(pointers);
        EXPECT_NE(desk_->views().at(0).sceneToRoom, before);
        EXPECT_EQ(pointers[1].depth, 0);
    }
    press(plain('v'));
    EXPECT_EQ(desk_->views().at(0).sceneToRoom, framed);
}

TEST_F(WindowView, OfAFilmIsThatOfItsBeginning) {
    openDesktop();
    const auto turn = [&] {
        std::array<haptic_bridge::PointerReport, 2> pointers{};
        pointers[1].turnX = 0.25F;
        desk_->windows().moveView(pointers);
    };
    turn();
    const auto begun = desk_->views().at(0).sceneToRoom;
    EXPECT_EQ(ask("film")["film"], "begins");
    turn();
    stroke();
    const nlohmann::json ended = ask("film");
    EXPECT_EQ(ended["folder"], "film_001");
    EXPECT_EQ(ended["from"], 0);
    EXPECT_EQ(ended["to"], 2);
    openDesktop(walls::Orbit::parse(ended["view"].get<std::string>(), "--view"));
    EXPECT_EQ(desk_->views().at(0).sceneToRoom, begun);
}

TEST_F(WindowView, OfAFilmIsRefusedWhereTheViewIsFixed) {
    master::DeskOptions options;
    options.view = walls::Orbit{};
    EXPECT_THROW(open(&force_, options), base::InputError);
}

TEST_F(WindowView, SaysThatTheViewIsAtALimitOfTheZoom) {
    openDesktop();
    const auto answerToWheel = [&](float notches) {
        std::array<haptic_bridge::PointerReport, 2> pointers{};
        pointers[1].wheel = notches;
        desk_->windows().moveView(pointers);
        return answerIn(1);
    };
    EXPECT_EQ(answerToWheel(1000), "") << "on the way to the limit";
    EXPECT_EQ(answerToWheel(1), master::kFarthest);
    EXPECT_EQ(answerToWheel(-1000), master::kFarthest) << "still shown";
    EXPECT_EQ(answerToWheel(-1), master::kNearest);
}

/// Returns level sand with a high summit in the north-west corner.
scene::Scene mountain() {
    scene::Scene scene = samples::flatScene(32, 24);
    scene.terrain.setHeight(0, 23, scene.terrain.height(0, 23) + 40 * sand::kUnitsPerCell);
    return scene;
}

class MountainDesk : public WindowView {
protected:
    MountainDesk() : WindowView(mountain()) {}
};

TEST_F(MountainDesk, BeginsWithTheWholeTerrainInView) {
    wall_ = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/desktop.toml");
    const auto ofTheFile = master::ViewSource(wall_, scene_, {}).at(0).sceneToRoom;
    open(&force_);
    EXPECT_LT(desk_->views().at(0).sceneToRoom[0], ofTheFile[0]) << "smaller than the wall file has it";
}

TEST_F(MountainDesk, ShowsItsBoardsAlsoWhenAllSandHasRisen) {
    wall_ = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/desktop.toml");
    const double unit = scene_.terrain.unit(), cell = scene_.terrain.cellSize();
    const sand::HeightSpan start = sand_.replica().surface().heights();
    const shapes::Box box = shapes::boxOutline({32 * cell, 24 * cell}, start.lowest * unit, start.highest * unit);
    open(&force_);
    // The ranks draw the floor below the lowest sand of the start.
    for (const int risen : {0, 20}) {
        desk_->views().frame({start.lowest + risen * sand::kUnitsPerCell, start.highest});
        const glm::dmat4 toRoom = glm::make_mat4(desk_->views().at(0).sceneToRoom.data());
        const glm::dmat4 toClip = walls::viewOf(wall_, wall_.tiles.front(), walls::Eye::middle).viewProjection * toRoom;
        for (const glm::dvec3& corner : shapes::cornersOf(box)) {
            const glm::dvec4 clip = toClip * glm::dvec4(corner, 1);
            EXPECT_LE(std::max(std::abs(clip.x), std::abs(clip.y)), clip.w) << corner.x << ", " << corner.y;
        }
    }
}

}  // namespace
