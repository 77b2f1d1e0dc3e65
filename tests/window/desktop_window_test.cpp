// SPDX-License-Identifier: Apache-2.0
// Windows that the wall file does not place, on the test's own X server.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <functional>

#include "base/input_error.hpp"
#include "render_node/gl/gl_context.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/screens/x_screen.hpp"
#include "tests/support/screens/x_server.hpp"

namespace {

/// A tile in a window on a screen of 640 x 480 pixels.
class DesktopWindow : public test::FolderTest {
protected:
    void SetUp() override {
        server_ = std::make_unique<support::XServer>(folder_, std::vector<std::string>{"640x480x24"});
    }
    void TearDown() override {
        screen_.reset();
        context_.reset();
        server_.reset();
    }
    void open(glm::ivec2 pixels, int tiles = 1) {
        walls::Grid grid;
        grid.columns = tiles;
        grid.tilePixels = pixels;
        wall_.grid = grid;
        wall_.tiles = walls::tilesOf(grid, walls::Stereo::mono);
        for (walls::Tile& tile : wall_.tiles) {
            tile.place.display = server_->display();
        }
        context_ = render_node::makeContext(render_node::Backend::glfw, wall_, wall_.tiles[0], false, "dunes");
        screen_ = std::make_unique<support::XScreen>(server_->display());
        window_ = screen_->windows().at(0);
    }
    /// Waits until the context has read an event after which `holds()` is true.
    [[nodiscard]] bool comes(const std::function<bool()>& holds) {
        const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (!holds()) {
            if (std::chrono::steady_clock::now() > until) {
                return false;
            }
            context_->windows().awaitEvents(0.1);
        }
        return true;
    }
    walls::Wall wall_;
    std::unique_ptr<support::XServer> server_;
    std::unique_ptr<render_node::GlContext> context_;
    std::unique_ptr<support::XScreen> screen_;
    unsigned long window_ = 0;
};

TEST_F(DesktopWindow, HasATitleAndAnIcon) {
    open({200, 100});
    EXPECT_EQ(screen_->title(window_), "Sandwall – dunes");
    EXPECT_EQ(screen_->classOf(window_), "sandwall");
    EXPECT_TRUE(screen_->hasIcon(window_));
}

TEST_F(DesktopWindow, NamesItsTileIfTheWallHasSeveralWindows) {
    open({200, 100}, 2);
    EXPECT_EQ(screen_->title(window_), "Sandwall – dunes, tile r1c1");
}

TEST_F(DesktopWindow, ClosingItIsTheQuitKeyInEverySession) {
    open({200, 100}, 2);
    screen_->askToClose(window_);
    std::vector<base::Keystroke> keys;
    EXPECT_TRUE(comes([&] { return !(keys = context_->windows().takeKeys()).empty(); }));
    EXPECT_EQ(keys, std::vector{base::kCloseKey});
}

TEST_F(DesktopWindow, BeginsWithTheSizeInTheWallFileIfItFits) {
    open({200, 100});
    EXPECT_EQ(context_->windows().followedSize(0), glm::ivec2(200, 100));
}

TEST_F(DesktopWindow, BeginsWithAtMostEightTenthsOfTheScreen) {
    open({1000, 500});
    EXPECT_EQ(context_->windows().followedSize(0), glm::ivec2(512, 256));
}

TEST_F(DesktopWindow, BeginsLargerByTheScaleOfTheMonitor) {
    support::XScreen(server_->display()).setScale(1.5);
    open({200, 100});
    EXPECT_EQ(context_->windows().followedSize(0), glm::ivec2(300, 150));
}

TEST_F(DesktopWindow, OpensWithoutAMonitor) {
    support::XScreen(server_->display()).switchMonitorOff();
    open({200, 100});
    EXPECT_EQ(context_->windows().followedSize(0), glm::ivec2(200, 100));
    screen_->type(window_, support::XScreen::kF11);
    screen_->resize(window_, 300, 200);
    EXPECT_TRUE(comes([&] { return context_->windows().followedSize(0) == glm::ivec2(300, 200); }))
        << "no monitor to fill";
}

TEST_F(DesktopWindow, ContinuesWhenItsMonitorGoesAway) {
    open({200, 100});
    screen_->type(window_, support::XScreen::kF11);
    ASSERT_TRUE(comes([&] { return context_->windows().followedSize(0) == glm::ivec2(640, 480); }));
    screen_->switchMonitorOff();
    // The size of a window may change, and that of a full screen may not.
    EXPECT_TRUE(comes([&] {
        screen_->resize(window_, 300, 200);
        return context_->windows().followedSize(0) == glm::ivec2(300, 200);
    }));
    EXPECT_EQ(context_->windows().takeKeys().size(), 1U) << "F11 alone; the session does not end";
}

TEST_F(DesktopWindow, ReportsItsPresentSize) {
    open({200, 100});
    for (const glm::ivec2 size : {glm::ivec2(300, 333), glm::ivec2(1, 1), glm::ivec2(700, 50)}) {
        screen_->resize(window_, size.x, size.y);
        EXPECT_TRUE(comes([&] { return context_->windows().followedSize(0) == size; })) << size.x;
    }
}

TEST_F(DesktopWindow, OfAWallOfSeveralTilesKeepsItsSize) {
    open({200, 100}, 2);
    EXPECT_EQ(context_->windows().followedSize(0), glm::ivec2(0));
}

TEST_F(DesktopWindow, OnWaylandWithoutXwaylandNamesWhatToInstall) {
    const char* const before = std::getenv("DISPLAY");
    const std::string kept = before == nullptr ? "" : before;
    unsetenv("DISPLAY");
    setenv("WAYLAND_DISPLAY", "wayland-0", 1);
    std::string line;
    try {
        walls::Grid grid;
        wall_.tiles = walls::tilesOf(grid, walls::Stereo::mono);
        (void)render_node::makeContext(render_node::Backend::glfw, wall_, wall_.tiles[0]);
    } catch (const base::InputError& error) {
        line = error.what();
    }
    unsetenv("WAYLAND_DISPLAY");
    if (!kept.empty()) {
        setenv("DISPLAY", kept.c_str(), 1);
    }
    EXPECT_NE(line.find("install Xwayland"), std::string::npos) << line;
}

}  // namespace
