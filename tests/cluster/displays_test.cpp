// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <thread>

#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/x_screen.hpp"
#include "tests/support/x_server.hpp"

namespace {

/// Sessions that draw in memory, on EGL, and in windows on an X server of the test's own.
class Displays : public SessionTest {
protected:
    void SetUp() override {
        server_ = std::make_unique<support::XServer>(folder_, std::vector<std::string>{"640x480x24"});
        environment_ = {"DISPLAY=" + server_->display()};
    }
    /// Two mono tiles side by side on the screen, each in its window.
    std::string placedWall() {
        const std::string file = wall(1, 2, "mono");
        std::ofstream(file, std::ios::app) << "[[place]]\ntiles = [\"r1c1\"]\nwindows = [[10, 20]]\n"
                                              "[[place]]\ntiles = [\"r1c2\"]\nwindows = [[200, 20]]\n";
        return file;
    }
    /// A session that shows still sand until it is told to stop, once its windows are there.
    std::unique_ptr<support::ChildProcess> showStillSand() {
        auto session = start({"--wall", placedWall(), "--scene", scene(), "--out", out()});
        // The first line is printed when the first frame may be shown; a second later it has been.
        EXPECT_TRUE(session->waitForOutput("hashes agree", kLong)) << session->output();
        const std::size_t first = session->output().find("hashes agree") + 1;
        const auto second = [&] { return session->output().find("hashes agree", first) != std::string::npos; };
        for (int i = 0; i < 600 && !second(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        EXPECT_TRUE(second()) << session->output();
        return session;
    }
    [[nodiscard]] pictures::Image tile(const std::string& name) const {
        return pictures::readPng(folder_ / "out" / ("tile_" + name + ".png"));
    }
    std::unique_ptr<support::XServer> server_;
};

TEST_F(Displays, EveryBackendShowsTheSameSandAndTheSamePictures) {
    std::string hash;
    std::vector<pictures::Image> expected;
    const std::vector<std::string> names{"r1c1_left", "r1c1_right", "r1c2_left", "r1c2_right"};
    for (const std::string backend : {"osmesa", "egl", "glfw"}) {
        const Ended ended = runToEnd({"--wall", wall(1, 2), "--scene", scene(), "--device", "script:gis", "--pace",
                                      "fast", "--steps", "120", "--gl", backend, "--out", out()});
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
    EXPECT_GT(pictures::compare(expected[0], expected[1], kLevels).badShare, kMostBad) << "eyes told apart";
}

TEST_F(Displays, TilesAreSeenOnTheScreenWhereTheWallFileSays) {
    const auto session = showStillSand();
    pictures::Image left;
    pictures::Image right;
    {
        const support::XScreen screen(server_->display());
        EXPECT_EQ(screen.windows().size(), 2U);
        left = screen.picture(10, 20, 96, 72);
        right = screen.picture(200, 20, 96, 72);
    }
    session->type("stop");
    EXPECT_EQ(session->wait(kLong), 0) << session->output();
    EXPECT_EQ(left.rgb, tile("r1c1_middle").rgb);
    EXPECT_EQ(right.rgb, tile("r1c2_middle").rgb);
    EXPECT_FALSE(left.rgb == right.rgb);
}

TEST_F(Displays, AKeyInAnyWindowChangesThePatternOfAllAndEscapeEnds) {
    const auto session = showStillSand();
    {
        const support::XScreen screen(server_->display());
        const pictures::Image sand = screen.picture(10, 20, 96, 72);
        const auto windows = screen.windows();
        ASSERT_EQ(windows.size(), 2U);
        screen.type(windows[1], 't');
        const auto changed = [&] { return screen.picture(10, 20, 96, 72).rgb != sand.rgb; };
        for (int i = 0; i < 600 && !changed(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        EXPECT_TRUE(changed()) << "the other tile goes on showing sand";
        session->type("pattern none");
        EXPECT_TRUE(screen.comesToShow(sand, 10, 20)) << "the sand comes back";
        screen.type(windows[0], 27);
    }
    EXPECT_EQ(session->wait(kLong), 0) << session->output();
}

TEST_F(Displays, ALostWindowIsNamedAndTheJobEnds) {
    const auto session = showStillSand();
    const std::vector<pid_t> family = session->family();
    {
        const support::XScreen screen(server_->display());
        screen.destroy(screen.windows().at(1));
    }
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    const std::string output = session->output();
    EXPECT_TRUE(output.find("on " + host() + ": output r1c") != std::string::npos) << output;
    EXPECT_TRUE(support::waitUntilGone(family, 10).empty());
}

TEST_F(Displays, AnXServerThatGoesIsNamedAndTheJobEnds) {
    const auto session = showStillSand();
    const std::vector<pid_t> family = session->family();
    server_->end();
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    EXPECT_NE(session->output().find(server_->display()), std::string::npos) << session->output();
    EXPECT_TRUE(support::waitUntilGone(family, 10).empty());
}

/// What a display lacks: one line with rank, host and cause, status 2, before the first frame.
class NoDisplay : public Displays {
protected:
    void expectOneLine(const std::string& more, const std::vector<std::string>& arguments, const std::string& part) {
        const std::string file = wall(1, 2, "mono");
        std::ofstream(file, std::ios::app) << more;
        std::vector<std::string> all{"--wall", file, "--scene", scene(), "--out", out(), "--frames", "3"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const Ended ended = runToEnd(all);
        EXPECT_EQ(ended.status, 2) << ended.output;
        EXPECT_EQ(std::count(ended.output.begin(), ended.output.end(), '\n'), 1) << ended.output;
        EXPECT_TRUE(ended.output.starts_with("rank ")) << ended.output;
        EXPECT_NE(ended.output.find(" on " + host() + ": "), std::string::npos) << ended.output;
        EXPECT_NE(ended.output.find(part), std::string::npos) << ended.output;
    }
};

TEST_F(NoDisplay, IsSaidWhereThereIsNone) {
    environment_ = {};
    expectOneLine("", {"--gl", "glfw"}, "DISPLAY");
}

TEST_F(NoDisplay, IsSaidOfOneThatCannotBeOpened) {
    expectOneLine("[[place]]\ntiles = [\"r1c2\"]\ndisplay = \":9876\"\n", {}, ":9876");
}

TEST_F(NoDisplay, IsSaidOfAMonitorThatIsNotThere) {
    expectOneLine("[[place]]\ntiles = [\"r1c2\"]\nmonitors = [\"DP-77\"]\n", {}, "DP-77");
}

TEST_F(NoDisplay, IsSaidOfAnEglDeviceThatIsNotThere) {
    expectOneLine("[[place]]\ntiles = [\"r1c1\"]\ndevice = 63\n", {"--gl", "egl"}, "no EGL device 63");
}

TEST_F(NoDisplay, IsSaidOfAShaderThatDoesNotCompile) {
    expectOneLine("", {"--gl", "osmesa", "--spoil-shader", "2"},
                  "render_node/shaders/sand.frag.glsl: the OpenGL driver does not compile it: ");
}

TEST_F(Displays, EveryWayToShowTwoEyesRuns) {
    constexpr int kTile = 96 * 72;
    const auto bytesOf = [&](const std::string& mode) {
        const Ended ended = runToEnd({"--wall", wall(1, 1), "--scene", scene(), "--frames", "2", "--pace", "fast",
                                      "--stereo", mode, "--out", out()});
        EXPECT_EQ(ended.status, 0) << ended.output;
        return summary()["per_rank"][0]["frame_buffer_bytes"].get<int>();
    };
    for (const std::string one : {"mono", "left", "right"}) {
        EXPECT_EQ(bytesOf(one), 8 * kTile) << one << ": colour and depth of one eye";
    }
    for (const std::string two : {"passive", "active"}) {
        EXPECT_EQ(bytesOf(two), 2 * 8 * kTile) << two;
    }
    for (const std::string packed : {"side_by_side", "top_bottom"}) {
        EXPECT_EQ(bytesOf(packed), (2 * 8 + 2 * 4) * kTile) << packed << ": and the colour of both together";
    }
    for (const std::string mixed : {"row_interlaced", "checkerboard", "anaglyph"}) {
        EXPECT_GE(bytesOf(mixed), (2 * 8 + 4) * kTile) << mixed;
    }
}

}  // namespace
