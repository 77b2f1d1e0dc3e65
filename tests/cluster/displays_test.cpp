// SPDX-License-Identifier: Apache-2.0
#include "base/not_yet_error.hpp"
#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"
#include "pictures/stereo_packing.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/screens/x_monitors.hpp"
#include "tests/support/screens/x_screen.hpp"
#include "tests/support/screens/x_server.hpp"

namespace {

/// Sessions that draw in memory, with EGL, and in windows on an X server that the test starts.
class Displays : public SessionTest {
protected:
    void SetUp() override {
        server_ = std::make_unique<support::XServer>(folder_, std::vector<std::string>{"640x480x24"});
        environment_ = {"DISPLAY=" + server_->display()};
    }
    /// Returns a wall file of two tiles side by side on the screen, each in its own window.
    std::string placedWall(const std::string& stereo = "mono") {
        std::string file = wall(1, 2, stereo);
        std::ofstream(file, std::ios::app) << "[[place]]\ntiles = [\"r1c1\"]\nwindows = [[10, 20]]\n"
                                              "[[place]]\ntiles = [\"r1c2\"]\nwindows = [[200, 20]]\n";
        return file;
    }
    /// Starts a session that shows still sand until it is stopped. Returns it when its windows show the sand.
    std::unique_ptr<support::ChildProcess> showStillSand() {
        auto session = start({"--wall", placedWall(), "--scene", scene(), "--out", out()});
        EXPECT_FALSE(session->waitForEvent("progress", [](const auto& event) { return event["frame"] > 1; }).is_null())
            << session->output();
        return session;
    }
    void expectNothingLeft(const std::vector<pid_t>& family) {
        EXPECT_TRUE(support::waitUntilGone(family, kLong).empty()) << "processes are still running";
    }
    [[nodiscard]] pictures::Image tile(const std::string& name, const std::string& capture = "") const {
        return pictures::readPng(folder_ / "out" / capture / ("tile_" + name + ".png"));
    }
    std::unique_ptr<support::XServer> server_;
};

TEST_F(Displays, EveryBackendShowsTheSameSandAndTheSamePictures) {
    std::string hash;
    std::vector<pictures::Image> expected;
    const std::vector<std::string> names{"r1c1_left", "r1c1_right", "r1c2_left", "r1c2_right"};
    for (const std::string backend : {"osmesa", "egl", "glfw"}) {
        const Ended ended = runToEnd({"--wall", wall(1, 2), "--scene", scene(), "--device", "script:gis", "--pace",
                                      "fast", "--steps", "60", "--gl", backend, "--out", out()});
        ASSERT_EQ(ended.status, 0) << ended.output;
        if (hash.empty()) {
            hash = summary()["state_hash"];
        }
        EXPECT_EQ(summary()["state_hash"], hash) << backend;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (expected.size() < names.size()) {
                expected.push_back(tile(names[i]));
            }
            EXPECT_LE(pictures::compare(expected[i], tile(names[i]), kLevels).badShare, kMostBad)
                << backend << " " << names[i];
        }
    }
    EXPECT_GT(pictures::compare(expected[0], expected[1], kLevels).badShare, kMostBad)
        << "both eyes see the same picture";
}

TEST_F(Displays, TilesAreSeenWhereTheWallFileSaysAndKeysAreObeyedInAnyWindow) {
    const auto session = showStillSand();
    pictures::Image left;
    pictures::Image right;
    {
        const support::XScreen screen(server_->display());
        const auto windows = screen.windows();
        ASSERT_EQ(windows.size(), 2U);
        left = screen.picture(10, 20, 96, 72);
        right = screen.picture(200, 20, 96, 72);
        screen.type(windows[1], 't');
        EXPECT_TRUE(session->waitUntil([&] { return screen.picture(10, 20, 96, 72).rgb != left.rgb; }))
            << "the other tile still shows sand";
        session->type("pattern none");
        EXPECT_TRUE(screen.comesToShow(left, 10, 20)) << "the sand does not come back";
        screen.type(windows[0], 'q', support::XScreen::kControl);
    }
    expectInOrder(*session);
    EXPECT_EQ(left.rgb, tile("r1c1_middle").rgb);
    EXPECT_EQ(right.rgb, tile("r1c2_middle").rgb);
    EXPECT_FALSE(left.rgb == right.rgb);
}

// Two outputs of one wall that each pack both eyes. The test changes them to every mode that outputs of their size can
// show.
TEST_F(Displays, TwoWindowsShowEachEyeItsPictureInEveryModeOfTheirSize) {
    const auto session = start({"--wall", placedWall("anaglyph"), "--scene", scene(), "--out", out(), "--no-pictures"});
    ASSERT_FALSE(session->waitForEvent("progress", [](const auto& event) { return event["frame"] > 1; }).is_null())
        << session->output();
    {
        const support::XScreen screen(server_->display());
        for (const std::string mode : {"anaglyph", "checkerboard", "anaglyph_dubois", "row_interlaced", "anaglyph_half",
                                       "active", "left", "mono", "right"}) {
            ask("stereo " + mode);
            const std::string folder = ask("capture").value("folder", "");
            const walls::Stereo stereo = walls::stereoNamed(mode);
            std::vector<pictures::Image> first;  // picture of each window
            for (const auto& [name, x] : {std::pair<std::string, int>{"r1c1", 10}, {"r1c2", 200}}) {
                std::vector<pictures::Image> shown;
                for (const walls::Eye eye : walls::eyesOf(stereo)) {
                    shown.push_back(tile(name + "_" + std::string(walls::eyeName(eye)), folder));
                }
                EXPECT_FALSE(shown.size() == 2 && shown[0].rgb == shown[1].rgb) << name << " in " << mode;
                if (walls::packsEyes(stereo)) {
                    shown = {pictures::packStereo(stereo, shown[0], shown[1])};
                    EXPECT_EQ(tile(name + "_output", folder).rgb, shown[0].rgb) << name << " in " << mode;
                }
                for (const pictures::Image& picture : shown) {  // two pictures if the eyes are shown in turn
                    EXPECT_TRUE(screen.comesToShow(picture, x, 20)) << "the window of " << name << " in " << mode;
                }
                first.push_back(shown[0]);
            }
            EXPECT_FALSE(first[0].rgb == first[1].rgb) << "both tiles show the same in " << mode;
        }
    }
    session->type("stop");
    expectInOrder(*session);
    EXPECT_EQ(summary()["divergences"], 0);
}

// The window shows the right eye where the mode has the left one. The pictures of the eyes stay those of the eyes.
TEST_F(Displays, AWindowShowsSwappedEyesAsSoonAsAnOperatorAsks) {
    const auto session = start({"--wall", placedWall("anaglyph"), "--scene", scene(), "--out", out(), "--no-pictures"});
    ASSERT_FALSE(session->waitForEvent("progress", [](const auto& event) { return event["frame"] > 1; }).is_null())
        << session->output();
    {
        const support::XScreen screen(server_->display());
        const std::string before = ask("capture").value("folder", "");
        for (const std::string mode : {"anaglyph", "row_interlaced", "active"}) {
            ask("stereo " + mode);
            ask("swap-eyes on");
            EXPECT_EQ(ask("status")["swap_eyes"], true);
            const std::string folder = ask("capture").value("folder", "");
            const pictures::Image left = tile("r1c1_left", folder), right = tile("r1c1_right", folder);
            EXPECT_EQ(left.rgb, tile("r1c1_left", before).rgb) << mode;
            ASSERT_FALSE(left.rgb == right.rgb);
            const walls::Stereo stereo = walls::stereoNamed(mode);
            EXPECT_TRUE(screen.comesToShow(walls::packsEyes(stereo) ? pictures::packStereo(stereo, right, left) : right,
                                           10, 20))
                << mode;
            ask("swap-eyes off");
        }
    }
    session->type("stop");
    expectInOrder(*session);
    EXPECT_EQ(summary()["divergences"], 0) << "all ranks drew the same view";
}

TEST_F(Displays, ADarkTileIsNamedUntilItsMonitorIsBack) {
    const support::XMonitors monitors(server_->display());
    monitors.addMode("screen", {96, 72});
    monitors.show({{"screen", {0, 0}, {96, 72}}});
    const std::string file = wall(1, 1, "mono");
    std::ofstream(file, std::ios::app) << "[[place]]\ntiles = [\"r1c1\"]\nmonitors = [\"screen\"]\n";
    const auto session = start({"--wall", file, "--scene", scene(), "--out", out(), "--show", "statistics"});
    ASSERT_FALSE(session->waitForEvent("progress", [](const auto& event) { return event["frame"] > 1; }).is_null())
        << session->output();
    EXPECT_EQ(ask("status")["dark"], nlohmann::json::array());
    monitors.switchOff("screen");
    EXPECT_FALSE(
        session->waitForEvent("monitor", {{"state", "off"}, {"output", "r1c1"}, {"monitor", "screen"}}).is_null())
        << session->output();
    EXPECT_EQ(ask("status")["dark"], nlohmann::json::array({"r1c1"}));
    monitors.show({{"screen", {200, 100}, {96, 72}}});
    EXPECT_FALSE(session->waitForEvent("monitor", {{"state", "on"}}).is_null()) << session->output();
    EXPECT_EQ(ask("status")["dark"], nlohmann::json::array());
    session->type("stop");
    expectInOrder(*session);
    const nlohmann::json dark = summary()["dark"];
    ASSERT_EQ(dark.size(), 1U) << dark;
    EXPECT_EQ(dark[0]["output"], "r1c1");
    EXPECT_EQ(dark[0]["times"], 1);
    EXPECT_EQ(dark[0]["at_end"], false);
}

TEST_F(Displays, ALostWindowIsNamedAndTheJobEnds) {
    const auto session = showStillSand();
    const std::vector<pid_t> family = session->family();
    {
        const support::XScreen screen(server_->display());
        screen.destroy(screen.windows().at(1));
    }
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    EXPECT_NE(session->output().find("on " + host() + ": output r1c"), std::string::npos) << session->output();
    expectNothingLeft(family);
}

TEST_F(Displays, AnXServerThatGoesIsNamedAndTheJobEnds) {
    const auto session = showStillSand();
    const std::vector<pid_t> family = session->family();
    server_->end();
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    EXPECT_NE(session->output().find(server_->display()), std::string::npos) << session->output();
    expectNothingLeft(family);
}

/// Faults of a display. Each is reported before the first frame, in one line with rank, host and cause. The exit status
/// says whether a wait may help. One session tests a display and one a shader. Monitors, devices and a missing DISPLAY
/// are tested in tests/window.
class NoDisplay : public Displays {
protected:
    void expectNamed(const std::string& more, const std::vector<std::string>& arguments, const std::string& named,
                     int status) {
        const std::string file = wall(1, 2, "mono");
        std::ofstream(file, std::ios::app) << more;
        std::vector<std::string> all{"--wall", file, "--scene", scene(), "--out", out(), "--frames", "3"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const Ended ended = runToEnd(all);
        expectOneLine(ended, named, status);
        expectOneLine(ended, "rank 2 (tile r1c2) on " + host() + ": ", status);
    }
};

TEST_F(NoDisplay, IsReportedOfOneThatCannotBeOpened) {
    expectNamed("[[place]]\ntiles = [\"r1c2\"]\ndisplay = \":9876\"\n", {}, ":9876", base::kExitNotYet);
}

TEST_F(NoDisplay, IsReportedOfAShaderThatDoesNotCompile) {
    expectNamed("", {"--gl", "osmesa", "--inject", "shader:rank=2"},
                "render_node/shaders/sand.frag.glsl: ", base::kExitBadInput);
}

}  // namespace
