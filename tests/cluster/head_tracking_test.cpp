// SPDX-License-Identifier: Apache-2.0
#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/run_program.hpp"

// Pictures are compared with EXPECT_TRUE, because EXPECT_EQ would print them as text.
namespace {

class HeadTracking : public SessionTest {
protected:
    std::string firstTile(const std::string& eye = "left") {
        const pictures::Image image = pictures::readPng(folder_ / "out" / ("tile_r1c1_" + eye + ".png"));
        return {image.rgb.begin(), image.rgb.end()};
    }
    void show(const std::vector<std::string>& more, const std::string& wallFile) {
        std::vector<std::string> arguments{"--wall", wallFile,   "--scene", scene(), "--pace",
                                           "fast",   "--frames", "30",      "--out", out()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Ended ended = runToEnd(arguments);
        ASSERT_EQ(ended.status, 0) << ended.output;
    }
};

// A tracked head must see the same picture as a viewer whose place in the wall file is the same.
TEST_F(HeadTracking, ATracedHeadSeesWhatAViewerSeesWhoStandsThere) {
    const std::string there = wall(1, 2);
    show({}, there);
    const std::string unmoved = firstTile();
    const std::string trace = write("head.csv", "time,x,y,z\n0,0.0,1.6,3.0\n0.2,0.4,1.5,2.5\n9,0.4,1.5,2.5\n");
    show({"--track", "trace:" + trace}, there);
    const std::string tracked = firstTile();
    EXPECT_NE(tracked, unmoved);
    EXPECT_EQ(summary()["head_tracking"]["packets"], 0);
    std::string text = read("wall.toml");
    const std::string eye = "eye = [0.0, 1.6, 3.0]";
    text.replace(text.find(eye), eye.size(), "eye = [0.4, 1.5, 2.5]");
    show({}, write("moved.toml", text));
    EXPECT_TRUE(firstTile() == tracked);
}

TEST_F(HeadTracking, AHeadTurnedToItsSideSeesWithOneEyeAboveTheOther) {
    const std::string trace = write("head.csv", "time,x,y,z,yaw,pitch,roll\n0,0,1.6,3,0,0,90\n");
    show({"--track", "trace:" + trace}, wall(1, 1));
    const std::string tracked = firstTile("right");
    // When the head is rolled to the left by a right angle, the right eye is above.
    std::string text = read("wall.toml");
    text.replace(text.find("[stereo]"), 0, "right = [0.0, 1.0, 0.0]\n");
    show({}, write("rolled.toml", text));
    EXPECT_TRUE(firstTile("right") == tracked);
    EXPECT_FALSE(firstTile("left") == tracked);
}

// With --pace fast a wall counts time in frames. So the time of its 30th frame shows its frame rate.
TEST_F(HeadTracking, AWallOf120HertzShowsTheEyesInTurnInTheHeadsOwnTime) {
    const std::string trace =
        write("head.csv", "time,x,y,z\n0,0,1.6,3\n0.24,0.4,1.5,2.5\n0.26,0.4,1.5,2.5\n0.49,-0.4,1.7,2.8\n");
    (void)wall(1, 1, "active");
    const std::string text = read("wall.toml"), eye = "eye = [0.0, 1.6, 3.0]";
    const auto seen = [&](const std::string& refresh, const std::string& track, const std::string& from) {
        std::string other = refresh + text;
        other.replace(other.find(eye), eye.size(), "eye = " + from);
        show({"--track", track}, write("other.toml", other));
        return firstTile("left") + firstTile("right");
    };
    // Frame 30 is at 0.25 s at a rate of 120 Hz, and at 0.5 s at 60 Hz.
    const std::string fast = seen("refresh = 120\n", "trace:" + trace, "[0.0, 1.6, 3.0]");
    EXPECT_TRUE(fast == seen("", "none", "[0.4, 1.5, 2.5]"));
    const std::string usual = seen("", "trace:" + trace, "[0.0, 1.6, 3.0]");
    EXPECT_TRUE(usual == seen("", "none", "[-0.4, 1.7, 2.8]"));
    EXPECT_FALSE(fast == usual);
}

TEST_F(HeadTracking, ATrackerThatFallsSilentIsReportedAndItsLastPoseHeld) {
    const std::string wallFile = wall(1, 1);
    const auto session = start({"--wall", wallFile, "--scene", scene(), "--track", "opentrack:0", "--out", out()});
    const nlohmann::json listening = session->waitForEvent("head_tracking", {{"state", "listening"}});
    ASSERT_FALSE(listening.is_null()) << session->output();
    expectFrames(*session);
    const support::Ran sent = support::runProgram(
        "sandwall-track", "--send opentrack:" + std::to_string(listening["port"].get<int>()) + " --seconds 0.5");
    EXPECT_EQ(sent.status, 0) << sent.output;
    EXPECT_FALSE(session->waitForEvent("head_tracking", {{"state", "lost"}}).is_null()) << session->output();
    session->type("stop");
    expectInOrder(*session);
    EXPECT_GT(summary()["head_tracking"]["packets"], 0);
    EXPECT_GE(summary()["head_tracking"]["lost"], 1);
    const std::string held = firstTile();
    show({"--track", "none"}, wallFile);
    EXPECT_FALSE(held == firstTile()) << "the last pose was not held";
}

}  // namespace
