// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "base/not_yet_error.hpp"
#include "tests/support/screens/x_screen.hpp"
#include "tests/support/screens/x_server.hpp"
#include "tests/window/probe_fixture.hpp"

namespace {

using support::XScreen;

constexpr int kAcross = 800;  // [pixel], width of the screen
constexpr int kDown = 600;

class Window : public ProbeTest {
protected:
    void SetUp() override {
        server_ = std::make_unique<support::XServer>(
            folder_,
            std::vector<std::string>{std::to_string(kAcross) + "x" + std::to_string(kDown) + "x24", "640x480x24"});
    }
    void TearDown() override {
        probe_.reset();  // must end before the server of its screens
    }
    /// Shows windows of 320 x 240 pixels at these places.
    std::string show(const std::vector<std::string>& places, const std::vector<std::string>& more = {}) {
        return startAndShow(words(places, more));
    }
    [[nodiscard]] std::vector<std::string> words(const std::vector<std::string>& places,
                                                 const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all{"--display", server_->display()};
        for (const std::string& place : places) {
            all.insert(all.end(), {"--at", place});
        }
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Returns the only window.
    [[nodiscard]] unsigned long onlyWindow(const XScreen& screen) const {
        const std::vector<unsigned long> seen = screen.windows();
        EXPECT_EQ(seen.size(), 1U);
        return seen.empty() ? 0 : seen.front();
    }
    std::unique_ptr<support::XServer> server_;
};

TEST_F(Window, ShowsThePicturePixelForPixelAtItsPlace) {
    const std::string output = show({"40,30"});
    EXPECT_EQ(linesOf(output, "context").at(0), "glfw");
    EXPECT_TRUE(linesOf(output, "shortcoming").empty()) << output;
    const XScreen screen(server_->display());
    EXPECT_TRUE(screen.comesToShow(picture("left"), 40, 30));
    EXPECT_FALSE(screen.picture(41, 30, 320, 240).rgb == picture("left").rgb) << "the picture has no features";
    // The window has no frame and no title. The screen around it is black.
    const pictures::Image above = screen.picture(0, 0, kAcross, 30);
    EXPECT_TRUE(std::all_of(above.rgb.begin(), above.rgb.end(), [](int level) { return level == 0; }));
}

/// Returns a picture of which the given rows and columns, counted from the top left, show another one.
pictures::Image withPart(pictures::Image picture, const pictures::Image& other, int x0, int y0, int x1, int y1) {
    for (int y = y0; y < y1; ++y) {
        const auto at = [&](int x) { return 3 * (static_cast<std::ptrdiff_t>(y) * picture.width + x); };
        std::copy(other.rgb.begin() + at(x0), other.rgb.begin() + at(x1), picture.rgb.begin() + at(x0));
    }
    return picture;
}

// With a graphics card the whole window would be swapped. This X server draws with the processor.
TEST_F(Window, CopiesOnlyThePixelsThatChanged) {
    (void)show({"40,30"});
    const XScreen screen(server_->display());
    ASSERT_TRUE(screen.comesToShow(picture("left"), 40, 30));
    (void)ask("part 100 40 260 200", "part shown");  // rows from the bottom
    const pictures::Image shown = withPart(picture("left"), picture("right"), 100, 40, 260, 200);
    EXPECT_FALSE(shown.rgb == picture("left").rgb);
    EXPECT_TRUE(screen.comesToShow(shown, 40, 30));
    (void)ask("frame 1", "frame 1 shown");
    EXPECT_EQ(screen.picture(40, 30, 320, 240), shown);
}

TEST_F(Window, ShowsAllPixelsAgainAfterItWasHidden) {
    (void)show({"40,30"});
    const XScreen screen(server_->display());
    ASSERT_TRUE(screen.comesToShow(picture("left"), 40, 30));
    screen.hideForAMoment(onlyWindow(screen));
    EXPECT_NE(screen.picture(40, 30, 320, 240), picture("left")) << "the server has kept the pixels";
    bool whole = false;
    for (int frame = 1; frame <= 50 && !whole; ++frame) {  // the server tells of it at some time
        const std::string number = std::to_string(frame);
        (void)ask("frame " + number, "frame " + number + " shown");
        whole = screen.picture(40, 30, 320, 240) == picture("left");
    }
    EXPECT_TRUE(whole);
}

TEST_F(Window, OpensForEachOutputWithThePictureOfItsEye) {
    (void)show({"0,0", "400,100"});
    const XScreen screen(server_->display());
    EXPECT_EQ(screen.windows().size(), 2U);
    EXPECT_TRUE(screen.comesToShow(picture("left"), 0, 0));
    EXPECT_TRUE(screen.comesToShow(picture("right"), 400, 100));
    EXPECT_FALSE(picture("left").rgb == picture("right").rgb);
}

TEST_F(Window, FillsTheMonitorThatIsNamed) {
    const std::string output = show({"screen"}, {"--width", "800", "--height", "600"});
    EXPECT_TRUE(linesOf(output, "shortcoming").empty()) << output;
    EXPECT_TRUE(XScreen(server_->display()).comesToShow(picture("left"), 0, 0));
}

TEST_F(Window, OpensOnTheScreenThatTheDisplayNames) {
    (void)startAndShow({"--at", "10,20", "--display", server_->display() + ".1"});
    EXPECT_TRUE(XScreen(server_->display()).windows().empty());
    EXPECT_TRUE(XScreen(server_->display() + ".1").comesToShow(picture("left"), 10, 20));
}

TEST_F(Window, TakesTheDisplayOfTheEnvironmentWhenTheWallFileNamesNone) {
    (void)startAndShow({"--at", "10,20"}, {"DISPLAY=" + server_->display()});
    EXPECT_TRUE(XScreen(server_->display()).comesToShow(picture("left"), 10, 20));
}

TEST_F(Window, ShowsTheEyesInTurnByTheNumberOfTheFrame) {
    const std::string output = show({"40,30"}, {"--active"});
    const std::vector<std::string> lines = linesOf(output, "shortcoming");
    ASSERT_EQ(lines.size(), 1U) << output;
    EXPECT_TRUE(lines[0].starts_with("output out1: no quad buffers; eyes in turn by frame")) << lines[0];
    const XScreen screen(server_->display());
    EXPECT_TRUE(screen.comesToShow(picture("left"), 40, 30));
    // The number of the frame decides, also if frames are left out.
    for (const int frame : {1, 2, 3, 5, 7, 10}) {
        const std::string number = std::to_string(frame);
        (void)ask("frame " + number, "frame " + number + " shown");
        EXPECT_TRUE(screen.comesToShow(picture(frame % 2 == 0 ? "left" : "right"), 40, 30)) << frame;
    }
}

TEST_F(Window, OfEyesInTurnSetsItsMonitorToTheRefreshRateOfTheWall) {
    const XScreen screen(server_->display());
    for (const double hertz : {60.0, 90.0, 120.0}) {
        screen.addMode(hertz);
    }
    for (const char* hertz : {"120", "90"}) {
        const std::string output =
            show({"screen"}, {"--active", "--refresh", hertz, "--width", "800", "--height", "600"});
        EXPECT_NEAR(screen.refreshRate(), std::stod(hertz), 0.1);
        const std::vector<std::string> lines = linesOf(output, "shortcoming");
        ASSERT_EQ(lines.size(), 1U) << output;
        EXPECT_TRUE(lines[0].starts_with("output out1: no quad buffers")) << lines[0];
        probe_.reset();
    }
}

TEST_F(Window, OfEyesInTurnNamesAMonitorThatIsTooSlow) {
    const XScreen screen(server_->display());
    screen.addMode(60);
    const std::string output = show({"screen"}, {"--active", "--refresh", "120", "--width", "800", "--height", "600"});
    const std::vector<std::string> lines = linesOf(output, "shortcoming");
    ASSERT_EQ(lines.size(), 2U) << output;
    EXPECT_EQ(lines[1], "output out1: monitor screen runs at 60 Hz instead of 120");
}

TEST_F(Window, SaysHowMuchOfItLiesOffTheScreen) {
    const std::string output = show({"700,30"});
    const std::vector<std::string> lines = linesOf(output, "shortcoming");
    ASSERT_EQ(lines.size(), 1U) << output;
    EXPECT_EQ(lines[0], "output out1: its window of 320 x 240 pixels at (700, 30) lies partly off the screen: " +
                            std::to_string(220 * 240) + " pixels are on no monitor");
}

TEST_F(Window, HasNoHardwareLockOfSwapsHere) {
    EXPECT_EQ(linesOf(show({"0,0"}), "swap").at(0), "lock no extension, ignore 0");
}

TEST_F(Window, HandsOverTheKeysThatArePressed) {
    (void)show({"0,0", "400,100"});
    const XScreen screen(server_->display());
    const std::vector<unsigned long> windows = screen.windows();
    ASSERT_EQ(windows.size(), 2U);
    screen.type(windows[0], 't');
    screen.type(windows[1], 't');
    screen.type(windows[0], 'q');
    screen.type(windows[1], XScreen::kEscape);
    const std::string output = ask("keys", "keys taken");
    EXPECT_EQ(linesOf(output, "key"), (std::vector<std::string>{"116", "116", "113", "27"})) << output;
}

TEST_F(Window, NamesTheMonitorsThereAreForOneThatIsNot) {
    start(words({"DP-7"}));
    EXPECT_EQ(lastLine(base::kExitNotYet), "window_probe: output out1: no monitor DP-7 on display " +
                                               server_->display() + "; there is screen (800 x 600)\n");
}

TEST_F(Window, RefusesAMonitorOfAnotherSize) {
    start(words({"screen"}));
    EXPECT_EQ(lastLine(2),
              "window_probe: output out1: monitor screen shows 800 x 600 pixels and has no mode of 320 x 240; correct "
              "the pixels in the wall file\n");
}

TEST_F(Window, NamesADisplayThatCannotBeOpened) {
    // Uses a display number that no test's server has. The number of a server that has ended may belong to the next
    // test's server, because numbers are given from 0 up.
    start({"--at", "0,0", "--display", ":9876"});
    EXPECT_TRUE(lastLine(base::kExitNotYet)
                    .starts_with("window_probe: --gl glfw: cannot open X display :9876; is its server running"));
}

TEST_F(Window, BlamesNoVariableOfMesaForADisplayThatMayStillCome) {
    start({"--at", "0,0", "--display", ":9876"}, {"MESA_GL_VERSION_OVERRIDE=2.1"});
    const std::string line = lastLine(base::kExitNotYet);
    EXPECT_EQ(line.find("MESA_GL_VERSION_OVERRIDE"), std::string::npos) << line;
}

TEST_F(Window, SaysWhenThereIsNoDisplayAtAll) {
    start({"--at", "0,0"});
    EXPECT_TRUE(lastLine(2).starts_with("window_probe: --gl glfw: no X display; set DISPLAY"));
}

TEST_F(Window, EndsTheRankWhenItIsDestroyed) {
    const std::string before = show({"0,0", "400,100"});
    const XScreen screen(server_->display());
    screen.destroy(screen.windows().back());  // the second window was opened last
    probe_->type("frame 1");
    EXPECT_EQ(lastLine(1, before.size()),
              "window_probe: failed: output out2: its window on " + server_->display() + " is gone\n");
}

TEST_F(Window, EndsTheRankWhenTheOnlyOneIsDestroyed) {
    const std::string before = show({"0,0"});
    {
        const XScreen screen(server_->display());
        screen.destroy(onlyWindow(screen));
    }
    probe_->type("frame 1");
    EXPECT_EQ(lastLine(1, before.size()),
              "window_probe: failed: output out1: its window on " + server_->display() + " is gone\n");
}

TEST_F(Window, EndsTheRankWhenItIsClosed) {
    const std::string before = show({"0,0"});
    {
        const XScreen screen(server_->display());
        screen.askToClose(onlyWindow(screen));
    }
    probe_->type("frame 1");
    EXPECT_EQ(lastLine(1, before.size()),
              "window_probe: failed: output out1: its window on " + server_->display() + " was closed\n");
}

// A recorded hand needs no pointer. A person may close its windows on a desktop nevertheless.
TEST_F(Window, OfAWallOnADeskEndsTheSessionWhenItIsClosed) {
    startAndShow({"--display", server_->display(), "--on-desk", "--at", "0,0", "--at", "400,100"});
    {
        const XScreen screen(server_->display());
        screen.askToClose(screen.windows().back());
    }
    const std::string output = ask("keys", "keys taken");
    EXPECT_EQ(linesOf(output, "key"), std::vector<std::string>{"113"});  // Ctrl+Q
    probe_->type("end");
    EXPECT_EQ(probe_->wait(kLong), 0);
}

TEST_F(Window, EndsTheRankWhenTheServerGoes) {
    const std::string before = show({"0,0"});
    const std::string display = server_->display();
    server_->end();
    probe_->type("frame 1");
    const std::string line = lastLine(1, before.size());
    EXPECT_TRUE(line.starts_with("rank 1 (r1c1) on ")) << line;
    EXPECT_NE(line.find(": the X server of " + display + " is gone\n"), std::string::npos) << line;
}

}  // namespace
