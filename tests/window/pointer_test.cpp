// SPDX-License-Identifier: Apache-2.0
// The pointer of a window on the test's own X server.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "base/input_error.hpp"
#include "render_node/gl/gl_context.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/screens/x_screen.hpp"
#include "tests/support/screens/x_server.hpp"

namespace {

using render_node::PointerEvent;
using Kind = PointerEvent::Kind;
using Keys = std::vector<base::Keystroke>;

/// A tile of 200 x 100 pixels in a window on a screen.
class Pointer : public test::FolderTest {
protected:
    void SetUp() override {
        server_ = std::make_unique<support::XServer>(folder_, std::vector<std::string>{"640x480x24"});
        walls::Grid grid;
        grid.tilePixels = {200, 100};
        wall_.grid = grid;
        wall_.tiles = walls::tilesOf(grid, walls::Stereo::mono);
        wall_.tiles[0].place.display = server_->display();
        wall_.tiles[0].outputs[0].window = glm::ivec2(30, 40);
    }
    void TearDown() override {
        screen_.reset();
        context_.reset();
        server_.reset();
    }
    void open(bool pointer) {
        context_ = render_node::makeContext(render_node::Backend::glfw, wall_, wall_.tiles[0], pointer);
        screen_ = std::make_unique<support::XScreen>(server_->display());
        window_ = screen_->windows().at(0);
    }
    /// Waits for an event of this kind. All events so far are in seen_.
    [[nodiscard]] bool comes(Kind kind) {
        const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (std::ranges::none_of(seen_, [&](const PointerEvent& event) { return event.kind == kind; })) {
            if (std::chrono::steady_clock::now() > until) {
                return false;
            }
            context_->windows().awaitEvents(0.1);
            const auto events = context_->windows().takePointer();
            seen_.insert(seen_.end(), events.begin(), events.end());
        }
        return true;
    }
    walls::Wall wall_;
    std::unique_ptr<support::XServer> server_;
    std::unique_ptr<render_node::GlContext> context_;
    std::unique_ptr<support::XScreen> screen_;
    unsigned long window_ = 0;
    std::vector<PointerEvent> seen_;
};

TEST_F(Pointer, ReportsMotionsButtonsAndTheWheelWithTheirPlacesInOrder) {
    open(true);
    screen_->point(window_, 120, 60);
    ASSERT_TRUE(comes(Kind::move));
    EXPECT_EQ(seen_.back().at, glm::dvec2(120, 60));
    EXPECT_GT(seen_.back().ns, 0);
    seen_.clear();
    screen_->button(window_, 1, true);
    screen_->button(window_, 1, false);
    screen_->button(window_, 3, true);
    screen_->button(window_, 3, false);
    screen_->button(window_, 5, true);  // towards the person
    screen_->button(window_, 5, false);
    ASSERT_TRUE(comes(Kind::wheel));
    std::vector<Kind> kinds;
    for (const PointerEvent& event : seen_) {
        kinds.push_back(event.kind);
        EXPECT_EQ(event.at, glm::dvec2(120, 60));
    }
    EXPECT_EQ(kinds, (std::vector{Kind::press, Kind::release, Kind::turnPress, Kind::viewRelease, Kind::wheel}));
    EXPECT_EQ(seen_.back().notches, 1);
    EXPECT_TRUE(context_->windows().takePointer().empty()) << "they are taken";
}

TEST_F(Pointer, OfAnotherSessionIsNotRead) {
    open(false);
    screen_->point(window_, 120, 60);
    screen_->button(window_, 1, true);
    screen_->type(window_, 'x');
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    Keys keys;
    while (keys.empty() && std::chrono::steady_clock::now() < until) {
        keys = context_->windows().takeKeys();
    }
    EXPECT_EQ(keys, (Keys{{'x', 0, 0}})) << "events before this one have come";
    EXPECT_TRUE(context_->windows().takePointer().empty());
}

TEST_F(Pointer, KeysAreCodesAndModifiers) {
    open(true);
    using support::XScreen;
    screen_->type(window_, 'z', XScreen::kControl);
    screen_->type(window_, 'r', XScreen::kShift);
    screen_->type(window_, 'r');
    screen_->type(window_, '1', XScreen::kShift);  // types an exclamation mark, to which Shift belongs
    screen_->type(window_, ' ');
    screen_->type(window_, XScreen::kF1);
    screen_->type(window_, XScreen::kF9);
    screen_->type(window_, XScreen::kF12);
    screen_->type(window_, XScreen::kPageUp);
    screen_->type(window_, XScreen::kHome, XScreen::kControl);
    screen_->type(window_, XScreen::kEscape);
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    Keys keys;
    while (keys.size() < 11 && std::chrono::steady_clock::now() < until) {
        const Keys more = context_->windows().takeKeys();
        keys.insert(keys.end(), more.begin(), more.end());
    }
    using base::Keystroke;
    EXPECT_EQ(keys, (Keys{{'z', Keystroke::kControl, 0},
                          {'r', Keystroke::kShift, 0},
                          {'r', 0, 0},
                          {'!', 0, 0},
                          {' ', 0, 0},
                          {Keystroke::kF1, 0, 0},
                          {Keystroke::kF1 + 8, 0, 0},
                          {Keystroke::kF12, 0, 0},
                          {Keystroke::kPageUp, 0, 0},
                          {Keystroke::kHome, Keystroke::kControl, 0},
                          {Keystroke::kEscape, 0, 0}}));
}

TEST_F(Pointer, EscapeLiftsTheToolOfAStroke) {
    open(true);
    screen_->point(window_, 120, 60);
    screen_->button(window_, 1, true);
    screen_->type(window_, support::XScreen::kEscape);
    screen_->button(window_, 1, false);
    screen_->type(window_, support::XScreen::kEscape);
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    Keys keys;
    std::vector<Kind> kinds;
    while (keys.empty() && std::chrono::steady_clock::now() < until) {
        keys = context_->windows().takeKeys();
        for (const render_node::PointerEvent& event : context_->windows().takePointer()) {
            if (event.kind != Kind::move) {
                kinds.push_back(event.kind);
            }
        }
    }
    EXPECT_EQ(kinds, (std::vector{Kind::press, Kind::release})) << "the button comes up later";
    EXPECT_EQ(keys, (Keys{{base::Keystroke::kEscape, 0, 0}})) << "only the second one is a key of the session";
}

TEST_F(Pointer, ClosingAWindowIsTheQuitKey) {
    open(true);
    screen_->askToClose(window_);
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    Keys keys;
    while (keys.empty() && std::chrono::steady_clock::now() < until) {
        keys = context_->windows().takeKeys();
    }
    EXPECT_EQ(keys, Keys{base::kCloseKey});
}

// The window has no focus, so that GLFW does not release its buttons when it is hidden.
TEST_F(Pointer, AReleaseThatTheHiddenWindowDoesNotGetComesAllTheSame) {
    open(true);
    screen_->focusAnotherWindow();
    screen_->point(window_, 120, 60);
    if (!screen_->pressForReal(1, true)) {
        GTEST_SKIP() << "no libXtst.so.6; install Debian's libxtst6";
    }
    ASSERT_TRUE(comes(Kind::press));
    for (int looks = 0; looks < 5; ++looks) {  // as a rank that shows frames
        context_->windows().awaitEvents(0.05);
        const auto events = context_->windows().takePointer();
        seen_.insert(seen_.end(), events.begin(), events.end());
    }
    const auto released = [](const PointerEvent& event) { return event.kind == Kind::release; };
    EXPECT_EQ(std::ranges::count_if(seen_, released), 0) << "the button is held";
    screen_->hide(window_);
    ASSERT_TRUE(screen_->pressForReal(1, false));
    ASSERT_TRUE(comes(Kind::release));
    EXPECT_EQ(seen_.back().at, glm::dvec2(120, 60));
}

TEST_F(Pointer, NeedsAWindow) {
    EXPECT_THROW((void)render_node::makeContext(render_node::Backend::osmesa, wall_, wall_.tiles[0], true),
                 base::InputError);
}

}  // namespace
