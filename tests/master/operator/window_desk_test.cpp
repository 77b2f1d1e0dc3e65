// SPDX-License-Identifier: Apache-2.0
// Keys, wheels and pointers of the windows, without a wall.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "tests/master/operator/window_desk_fixture.hpp"

namespace {

using base::Keystroke;
using test::control;
using test::kShiftR;
using test::plain;

class WindowDesk : public test::WindowDeskTest {};

TEST_F(WindowDesk, BeginsWithAToolThatCanBeSeenIfAskedTo) {
    const double cell = scene_.terrain.cellSize();
    master::DeskOptions options;
    options.pointer = options.visibleTool = true;
    scene_.material.toolRadius = 0.5 * cell;
    open(&force_, options);
    EXPECT_EQ(radiusAsked(), 2 * sand::kProbePerCell) << "the least size of a usual tool";
    press(plain('0'));
    EXPECT_EQ(radiusAsked(), sand::kProbePerCell / 2) << "the scene's";
    scene_.material.toolRadius = 3 * cell;
    const std::size_t asked = edits().size();
    open(&force_, options);
    EXPECT_EQ(edits().size(), asked) << "the scene's tool is large enough";
}

TEST_F(WindowDesk, KeepsTheToolOfTheSceneOnAFullDisk) {
    master::DeskOptions options;
    options.pointer = options.visibleTool = true;
    scene_.material.toolRadius = 0.5 * scene_.terrain.cellSize();
    room_ = false;
    const std::size_t asked = edits().size();
    EXPECT_NO_THROW(open(&force_, options));
    EXPECT_EQ(edits().size(), asked);
}

TEST_F(WindowDesk, TakesKeysIfTheHandIsThePointer) {
    desk_->obey({{.key = kShiftR}, {.key = plain('h')}});
    EXPECT_TRUE(edits().empty()) << "another hand";
    EXPECT_FALSE(desk_->views().layers().shows(lockstep::Overlay::help));
    openForPointer();
    press(kShiftR);
    press(plain('h'));
    ASSERT_EQ(edits().size(), 1U);
    EXPECT_EQ(edits()[0].kind, sand::Edit::reset);
    EXPECT_TRUE(desk_->views().layers().shows(lockstep::Overlay::help));
    press(plain('3'));
    press({Keystroke::kF1, 0, 0});
    ASSERT_EQ(edits().size(), 2U);
    EXPECT_EQ(edits()[1].tuning.tool.kind, sand::ToolKind::rectangle);
    EXPECT_FALSE(desk_->views().layers().shows(lockstep::Overlay::help));
    press(control('z'));
    EXPECT_EQ(edits().size(), 2U) << "there is no stroke to undo";
    press(plain('x'));
    EXPECT_EQ(edits().size(), 2U) << "a key without an action";
}

TEST_F(WindowDesk, AnswersEachKeyInTheWindowWhereItWasPressed) {
    openForPointer();
    EXPECT_EQ(answerIn(0), lockstep::hint());
    press(control('z'));
    EXPECT_EQ(answerIn(1), "nothing to undo");
    stroke();
    press(control('z'));
    show(edits()[0]);
    EXPECT_EQ(answerIn(1), "undone; nothing more to undo");
    press(plain('3'));
    EXPECT_EQ(answerIn(1), "tool: rectangle");
    press(plain('.'));
    EXPECT_EQ(answerIn(1), "heading 355°");
    press(plain('w'));
    EXPECT_EQ(answerIn(1), "humidity 10 %");
    press(plain('0'));
    EXPECT_EQ(answerIn(1), "tool and humidity of the scene, usual depth");
    press(plain(' '));
    EXPECT_EQ(answerIn(1), "paused; Space resumes");
    press(plain('1'));
    EXPECT_EQ(answerIn(1), "tool: sphere; the sand waits until Space resumes");
    press(plain(' '));
    EXPECT_EQ(answerIn(1), "resumed");
    press(plain('m'));
    EXPECT_EQ(answerIn(1), "hill-shade shown");
    press({Keystroke::kHome, 0, 0});
    EXPECT_EQ(answerIn(1), "this wall's view is fixed");
    press(control('s'));
    desk_->close();
    EXPECT_EQ(answerIn(1), "sand saved as saves/save_001.sand");
    EXPECT_EQ(answerIn(2), "");
    EXPECT_EQ(answerIn(0), lockstep::hint()) << "answers of one window leave it to the others";
}

// The rank itself switches a window that the picture follows to full screen.
TEST_F(WindowDesk, AnswersF11WhereWindowsKeepTheirSize) {
    for (const char* name : {"desktop", "tiled_3x4"}) {
        wall_ = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/" + std::string(name) + ".toml");
        openForPointer();
        press({Keystroke::kF11, 0, 0});
        EXPECT_EQ(answerIn(1), wall_.tiles.size() == 1 ? "" : "this wall's windows keep their size");
    }
}

TEST_F(WindowDesk, OfAnotherHandHintsAtNothing) { EXPECT_TRUE(desk_->windows().answers(host::monotonicNs()).empty()); }

TEST_F(WindowDesk, PausesAndResumesBySpace) {
    openForPointer();
    press(plain(' '));
    EXPECT_TRUE(desk_->paused());
    press(plain(' '));
    EXPECT_FALSE(desk_->paused());
}

TEST_F(WindowDesk, SavesByControlSUnderTheNextFreeName) {
    openForPointer();
    std::filesystem::create_directory(folder_ / "saves");
    std::ofstream(folder_ / "saves/save_002.sand") << "of an earlier session";
    press(control('s'));
    press(control('s'));
    desk_->close();
    EXPECT_TRUE(std::filesystem::exists(folder_ / "saves/save_001.sand"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "saves/save_003.sand"));
    EXPECT_EQ(std::filesystem::file_size(folder_ / "saves/save_002.sand"), 21U) << "that of an earlier session";
}

TEST_F(WindowDesk, WantsACaptureByF12) {
    openForPointer();
    press({Keystroke::kF12, 0, 0});
    EXPECT_TRUE(desk_->needsCapture());
}

TEST_F(WindowDesk, BeginsAndEndsAFilmByF9) {
    openForPointer();
    const Keystroke f9{Keystroke::kF1 + 8, 0, 0};
    press(f9);
    EXPECT_EQ(answerIn(1), "film begins; the same again ends it");
    stroke();
    press(f9);
    EXPECT_EQ(answerIn(1), "film of 0.0 s: make it by sandwall film --from 0 --to 2") << "no launcher listens";
    EXPECT_TRUE(std::filesystem::is_directory(folder_ / "film_001"));
    press(f9);
    press(f9);
    EXPECT_EQ(answerIn(1), "film: the sand has made no step since the film began, so the film would have no picture");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "film_002"));
}

TEST_F(WindowDesk, ChangesTheToolByKeysWithinItsLimitsAndBackToTheScene) {
    openForPointer();
    for (int i = 0; i < 60; ++i) {  // the scene's tool is smaller than both limits
        press(plain(i < 40 ? '+' : '-'));
        show(edits().back());
        const std::int32_t most = 3 * sand::kProbePerCell;  // a quarter of 24 cells long
        EXPECT_LE(edits().back().tuning.tool.radius, most);
        EXPECT_TRUE(i != 39 || edits().back().tuning.tool.radius == most);
    }
    EXPECT_EQ(edits().back().tuning.tool.radius, sand::kProbePerCell) << "two cells long";
    press(plain('4'));
    show(edits().back());
    press(plain(','));
    show(edits().back());
    const sand::Heading left = edits().back().tuning.tool.heading;
    EXPECT_EQ(left, sand::headingOf(5).value());
    press(plain('w'));
    show(edits().back());
    EXPECT_NE(edits().back().tuning, scene::tuningOf(scene_.material, scene_.grid()));
    press(plain('0'));
    EXPECT_EQ(edits().back().tuning, scene::tuningOf(scene_.material, scene_.grid()));
}

TEST_F(WindowDesk, ChangesDepthAndSizeByTheWheelWithinTheirLimits) {
    openForPointer();
    std::array<haptic_bridge::PointerReport, 2> pointers{};
    desk_->windows().turnWheels(pointers);
    EXPECT_TRUE(edits().empty()) << "a wheel that rests";
    pointers[1].depth = 2;
    desk_->windows().turnWheels(pointers);
    EXPECT_NEAR(desk_->windows().depth(), 0.7, 1e-12);
    EXPECT_EQ(answerIn(1), "depth 70 % of the radius");
    pointers[1].depth = -100;
    desk_->windows().turnWheels(pointers);
    EXPECT_EQ(desk_->windows().depth(), haptic_bridge::kShallowest);
    EXPECT_EQ(answerIn(1), "depth 10 % of the radius, the shallowest");
    press(plain('0'));
    EXPECT_EQ(desk_->windows().depth(), haptic_bridge::kUsualDepth);
    pointers[1] = {};
    pointers[1].size = -100;
    desk_->windows().turnWheels(pointers);
    EXPECT_EQ(edits().back().tuning.tool.radius, 3 * sand::kProbePerCell) << "away from the user is larger";
}

constexpr Keystroke kEscape{Keystroke::kEscape, 0, 0};

TEST_F(WindowDesk, EscapeClosesTheHelpAndEndsTheSessionOnlyIfItComesTwice) {
    openForPointer();
    master::WindowDesk& windows = desk_->windows();
    windows.obey(plain('h'), 1, 0);
    windows.obey(kEscape, 1, 1);
    EXPECT_FALSE(desk_->views().layers().shows(lockstep::Overlay::help));
    EXPECT_FALSE(desk_->stopAsked());
    windows.obey(kEscape, 1, 2);
    EXPECT_EQ(answerIn(1), master::kEndsByAnother);
    windows.obey({Keystroke::kEscape, 0, 1}, 1, 3);
    EXPECT_FALSE(desk_->stopAsked()) << "a held key is one press";
    windows.obey(kEscape, 1, 3 + master::kLeaveNs);
    EXPECT_FALSE(desk_->stopAsked()) << "it comes too late, and asks again";
    windows.obey(kEscape, 1, 3 + 2 * master::kLeaveNs);
    EXPECT_TRUE(desk_->stopAsked());
}

TEST_F(WindowDesk, AsksOnAWallWithoutAPointerToo) {
    desk_->windows().obey(kEscape, 1, 0);
    EXPECT_FALSE(desk_->stopAsked());
    EXPECT_EQ(answerIn(1), master::kEndsByAnother);
    desk_->windows().obey(kEscape, 1, 1);
    EXPECT_TRUE(desk_->stopAsked());
}

TEST_F(WindowDesk, AnswersAKeyWithoutMeaning) {
    openForPointer();
    press(plain('q'));
    EXPECT_FALSE(desk_->stopAsked());
    EXPECT_EQ(answerIn(1), master::kNoSuchKey);
}

TEST_F(WindowDesk, LeavesKeysOfTheDesktopAndHeldKeysUnanswered) {
    openForPointer();
    for (const Keystroke key : {Keystroke{'x', Keystroke::kSuper, 0}, Keystroke{'x', Keystroke::kAlt, 0},
                                Keystroke{'x', 0, 1}, Keystroke{'u', 0, 1}}) {
        press(key);
        EXPECT_NE(answerIn(1), master::kNoSuchKey) << key.code;
    }
}

}  // namespace
