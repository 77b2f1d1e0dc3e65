// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <filesystem>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

class Lockstep : public SessionTest {};

// dem_test.cpp compares the replicas of a TIN.
TEST_F(Lockstep, OneFourAndTwelveRanksOfAnyThreadsHashLikeTheirJournal) {
    struct Way {
        int rows, columns;
        const char* sandThreads;
    };
    std::string expected;
    for (const Way& way : {Way{1, 1, "1"}, Way{2, 2, "3"}, Way{3, 4, "1"}}) {
        const Ended ended =
            runToEnd({"--wall", wall(way.rows, way.columns), "--scene", scene(), "--device", "script:gis", "--pace",
                      "fast", "--steps", "150", "--out", out(), "--no-pictures", "--sand-threads", way.sandThreads});
        ASSERT_EQ(ended.status, 0) << ended.output;
        const nlohmann::json result = summary();
        const std::string hash = result["state_hash"];
        EXPECT_EQ(hash.size(), 16U);
        EXPECT_EQ(result["steps"], 150);
        EXPECT_EQ(result["ranks"], way.rows * way.columns);
        EXPECT_EQ(result["divergences"], 0);
        EXPECT_EQ(result["server_divergences"], 0);
        EXPECT_EQ(result["volume_final"].get<std::int64_t>() + result["volume_outflow"].get<std::int64_t>(),
                  result["volume_initial"].get<std::int64_t>());
        EXPECT_EQ(hash, replayedHash());
        expected = expected.empty() ? hash : expected;
        EXPECT_EQ(hash, expected) << way.rows << " x " << way.columns << " ranks of " << way.sandThreads << " threads";
    }
}

// 256 columns have two levels of detail.
constexpr const char* kTwoLevels =
    "name = \"large\"\n[field]\ncolumns = 256\nrows = 256\n[terrain]\nheight = 0.2\n[material]\n[tool]\nradius = "
    "0.04\n";

// The hand digs until the end, so that sand moves in the last frame. Its picture, which stays, is drawn whole with
// other levels. All frames between it and the first one are drawn in part.
TEST_F(Lockstep, TheLastFrameDrawsMovingSandAsFinelyAsSandAtRest) {
    const std::string large = write("large.toml", kTwoLevels);
    for (const auto& [what, sand] : {std::pair{"256 columns have two levels", large}, {"128 have one", scene()}}) {
        const Ended ended = runToEnd({"--wall", wall(1, 1), "--scene", sand, "--device", "script:gis", "--pace", "fast",
                                      "--steps", "80", "--out", out(), "--no-pictures"});
        ASSERT_EQ(ended.status, 0) << ended.output;
        const nlohmann::json views = summary()["per_rank"][0]["views"];
        EXPECT_EQ(views["whole"], sand == large ? 4 : 2) << what << ", two eyes: " << views;
        EXPECT_GT(views["in_part"], 5) << views;
    }
}

// A pause in a stroke changes the levels of the sand, and the end of the pause changes them back. The session ends in a
// pause, so that its last frame changes no level. The stroke takes 28 seconds, so that a busy machine does not miss it.
TEST_F(Lockstep, APausedFrameDrawsMovingSandAsFinelyAsSandAtRest) {
    const std::string stroke = write("long.strokes", "speed 0.05\nstroke\npoint -0.7 0\npoint 0.7 0\n");
    const auto session = start({"--wall", wall(1, 1), "--scene", write("large.toml", kTwoLevels), "--device",
                                "script:" + stroke, "--out", out(), "--no-pictures"});
    expectHand(*session);
    awaitStatus([](const nlohmann::json& now) { return now.value("step", 0) > 40; });
    for (const char* command : {"pause", "resume", "pause"}) {
        const int then = ask(command).value("frame", 0);
        awaitStatus([&](const nlohmann::json& now) { return now.value("frame", 0) > then + 3; });
    }
    ask("stop");
    expectInOrder(*session);
    const nlohmann::json views = summary()["per_rank"][0]["views"];
    EXPECT_EQ(views["whole"], 8) << "two eyes at the start, at two pauses and between them: " << views;
}

// The commands are typed at the launcher. There is no hand, so the master numbers the steps. control_test.cpp tests
// commands with a hand.
TEST_F(Lockstep, AnOperatorSettlesTheSandOnEveryReplica) {
    const auto session = start({"--wall", wall(1, 2), "--scene", scene(), "--device", "none", "--steps", "100000",
                                "--out", out(), "--no-pictures"});
    expectFrames(*session);
    session->type("settle");
    session->type("dance");
    EXPECT_FALSE(session->waitForEvent("command_refused").is_null()) << session->output();
    awaitStatus([](const nlohmann::json& now) { return now.value("edits", 0) == 1; });
    session->type("stop");
    expectInOrder(*session);
    EXPECT_EQ(summary()["edits"], 1);
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

TEST_F(Lockstep, ASessionLeavesItsPicturesAndItsFigures) {
    const auto began = std::chrono::steady_clock::now();
    const Ended ended =
        runToEnd({"--wall", wall(2, 2), "--scene", scene(), "--device", "script:gis", "--steps", "60", "--out", out()});
    expectInOrder(ended);
    for (const char* name : {"tile_r1c1_left.png", "tile_r1c1_right.png", "tile_r2c2_left.png", "tile_r2c2_right.png",
                             "wall_left.png", "wall_right.png", "wall_anaglyph.png", "session.journal"}) {
        EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / name)) << name;
    }
    const nlohmann::json result = summary();
    for (const char* path :
         {"/frames", "/fps", "/skew_us/p50", "/skew_us/p99", "/skew_us/max", "/latency_ms/mean", "/latency_ms/stddev",
          "/latency_ms/p50", "/latency_ms/p99", "/haptic_period_us/p50", "/haptic_period_us/p99",
          "/haptic_period_us/max", "/per_rank/3/draw_ms/p50", "/per_rank/3/memory_bytes"}) {
        const nlohmann::json::json_pointer pointer(path);
        ASSERT_TRUE(result.contains(pointer)) << path;
        EXPECT_TRUE(result[pointer].is_number()) << path << " is " << result[pointer];
    }
    // The force loop has a deadline in each millisecond. Each deadline is a tick or is counted as missed. There are at
    // most as many deadlines as milliseconds in the session. 60 steps that are at least 15 ms apart (StepClock) have
    // 900 deadlines. A busy machine may end the session while half of them are not counted yet.
    const std::chrono::duration<double, std::micro> all = std::chrono::steady_clock::now() - began;
    const double ticks = result["haptic"]["ticks"], missed = result["haptic"]["ticks_missed"];
    EXPECT_LE(ticks + missed, all.count() / 1000);
    EXPECT_GE(ticks + missed, 450);
    // Each deadline has at most one tick. So the mean period is at least a millisecond. Half of the periods are at most
    // the median, and 99 % are at most the 99th percentile. Both are known within 1 %. Their largest sum is no less
    // than that of the periods.
    const double middle = result["haptic_period_us"]["p50"], high = result["haptic_period_us"]["p99"],
                 longest = result["haptic_period_us"]["max"];
    EXPECT_GE(1.01 * (0.5 * middle + 0.49 * high + 0.01 * longest) + longest / ticks, 1000);
    // All periods together last less than a millisecond longer than their deadlines. Half of them are at least the
    // median. The server counts its ticks later than it takes the median: on a busy machine, after up to as many more.
    EXPECT_LE(middle, 1.01 * 2 * 1000 * (1 + 2 * (missed + 1) / ticks));
}

TEST_F(Lockstep, ARankThatSeesAnotherViewIsNamed) {
    const Ended ended = runToEnd({"--wall", wall(1, 3), "--scene", scene(), "--device", "script:gis", "--pace", "fast",
                                  "--steps", "100000", "--out", out(), "--inject", "view:rank=2,frame=20"});
    EXPECT_EQ(ended.status, 1) << ended.output;
    EXPECT_TRUE(ended.has("view_divergence", {{"frame", 20}, {"rank", 2}})) << ended.output;
    EXPECT_TRUE(support::holds(json("out/failure.json"), {{"what", "broken"}, {"rank", 2}, {"tile", "r1c2"}}));
    EXPECT_EQ(summary()["divergences"], 1);
}

TEST_F(Lockstep, AHapticServerThatComesBackIsLinkedAgain) {
    const std::string sceneFile = scene();
    const auto serve = [&](const std::string& address) {
        return std::make_unique<support::ChildProcess>(
            std::vector<std::string>{support::pathOfProgram("sandwall-haptic-server"), "--scene", sceneFile, "--device",
                                     "script:gis", "--listen", address, "--port-file", (folder_ / "port").string()},
            folder_ / "server.txt");
    };
    auto server = serve("127.0.0.1:0");
    ASSERT_FALSE(server->waitForEvent("listening").is_null()) << server->output();
    const std::string address = "127.0.0.1:" + std::to_string(std::stoi(read("port")));
    const auto session =
        start({"--wall", wall(1, 1), "--scene", sceneFile, "--haptic", address, "--out", out(), "--no-pictures"});
    ASSERT_FALSE(session->waitForEvent("link", {{"state", "linked"}, {"epoch", 1}}).is_null()) << session->output();
    server->signal(SIGKILL);
    ASSERT_FALSE(session->waitForEvent("without_hand", {{"reason", "lost"}, {"epoch", 2}}).is_null())
        << session->output();
    EXPECT_GT(ask("settle")["step"], 0) << "the master numbers the steps";
    server = serve(address);
    EXPECT_FALSE(session->waitForEvent("link", {{"state", "linked"}, {"epoch", 3}}).is_null()) << session->output();
    const int linked = ask("status")["step"];
    awaitStatus([&](const nlohmann::json& now) { return now.value("step", 0) > linked + 30; });
    session->type("stop");
    expectInOrder(*session);
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["server_divergences"], 0) << "the server must continue from the wall's sand";
    EXPECT_EQ(summary()["haptic"]["reconnects"], 1);
    const nlohmann::json told = summary();
    EXPECT_TRUE(support::holds(told["hand"],
                               {{"asked", "server"}, {"links", 2}, {"linked_at_end", true}, {"last_refusal", nullptr}}))
        << told["hand"];
    EXPECT_GT(told["hand"]["frames_with_hand"], 0);
    EXPECT_LT(told["hand"]["frames_with_hand"], told["frames"]) << "the server was away for a while";
    EXPECT_EQ(told["compared"], (nlohmann::json{{"at_end", true},
                                                {"server_at_end", true},
                                                {"last_whole", told["frames"]},
                                                {"frames_since", 0},
                                                {"first_difference", nullptr}}));
    EXPECT_EQ(told["unhealed"], 0);
    EXPECT_TRUE(told["journal"]["whole"]);
    EXPECT_EQ(told["pace"], "realtime");
    EXPECT_EQ(told["refresh_hz"], 60);
    EXPECT_GT(told["haptic"]["hand_ticks"], 0);
    EXPECT_EQ(told["haptic"]["literal"], false);
}

TEST_F(Lockstep, AnAbsentServerIsNamedAndTheWallGoesOn) {
    const Ended ended = runToEnd({"--wall", wall(1, 1), "--scene", scene(), "--haptic", "127.0.0.1:1", "--out", out(),
                                  "--steps", "30", "--no-pictures"});
    EXPECT_EQ(ended.status, 1) << "the hand that was asked for never came: " << ended.output;
    EXPECT_TRUE(ended.has("link", {{"state", "connecting"}, {"server", "127.0.0.1:1"}})) << ended.output;
    EXPECT_TRUE(ended.has("without_hand", {{"reason", "no_server"}})) << ended.output;
    EXPECT_EQ(summary()["steps"], 30);
    const nlohmann::json told = summary();
    const nlohmann::json never{{"asked", "server"}, {"links", 0}, {"frames_with_hand", 0}, {"linked_at_end", false}};
    EXPECT_TRUE(support::holds(told["hand"], never)) << told["hand"];
    EXPECT_TRUE(told["hand"]["last_refusal"].get<std::string>().starts_with("no answer (")) << told["hand"];
    EXPECT_TRUE(told["compared"]["server_at_end"].is_null()) << told["compared"];
}

TEST_F(Lockstep, AServerWithAnotherMaterialIsRefusedAndTheWallGoesOn) {
    const std::string other = write("other.toml", "name = \"test\"\n[field]\ncolumns = 128\n[terrain]\n[material]\n");
    const std::string portFile = (folder_ / "port").string();
    support::ChildProcess server({support::pathOfProgram("sandwall-haptic-server"), "--scene", other, "--device",
                                  "script:gis", "--listen", "127.0.0.1:0", "--port-file", portFile},
                                 folder_ / "server.txt");
    ASSERT_FALSE(server.waitForEvent("listening").is_null()) << server.output();
    const Ended ended = runToEnd({"--wall", wall(1, 1), "--scene", scene(), "--haptic",
                                  "127.0.0.1:" + std::to_string(std::stoi(read("port"))), "--out", out(), "--steps",
                                  "30", "--no-pictures"});
    EXPECT_EQ(ended.status, 1) << "the hand that was asked for never came: " << ended.output;
    EXPECT_TRUE(ended.has("without_hand", {{"reason", "refused"}})) << ended.output;
    EXPECT_EQ(summary()["steps"], 30);
    EXPECT_EQ(summary()["hand"]["links"], 0);
    EXPECT_TRUE(summary()["hand"]["last_refusal"].is_string()) << summary()["hand"];
}

}  // namespace
