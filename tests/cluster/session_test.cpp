// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace {

class Lockstep : public SessionTest {
protected:
    void expectOneHash(const std::string& scene, const std::vector<std::pair<int, int>>& walls);
};

/// A session of this scene on walls of so many rows and columns.
void Lockstep::expectOneHash(const std::string& scene, const std::vector<std::pair<int, int>>& walls) {
    std::string expected;
    for (const auto& [rows, columns] : walls) {
        const Ended ended = runToEnd({"--wall", wall(rows, columns), "--scene", scene, "--device", "script:gis",
                                      "--pace", "fast", "--steps", "240", "--out", out(), "--no-pictures"});
        ASSERT_EQ(ended.status, 0) << ended.output;
        const nlohmann::json result = summary();
        const std::string hash = result["state_hash"];
        EXPECT_EQ(hash.size(), 16U);
        EXPECT_EQ(result["steps"], 240);
        EXPECT_EQ(result["ranks"], rows * columns);
        EXPECT_EQ(result["divergences"], 0);
        EXPECT_EQ(result["server_divergences"], 0);
        EXPECT_EQ(result["volume_final"].get<std::int64_t>() + result["volume_outflow"].get<std::int64_t>(),
                  result["volume_initial"].get<std::int64_t>());
        const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal --hash");
        EXPECT_EQ(replayed.status, 0);
        EXPECT_EQ(replayed.output, hash + "\n");
        if (expected.empty()) {
            expected = hash;
        }
        EXPECT_EQ(hash, expected) << rows << " x " << columns << " ranks";
    }
}

TEST_F(Lockstep, OneFourAndThirteenRanksHashLikeTheirJournal) { expectOneHash(scene(), {{1, 1}, {2, 2}, {3, 4}}); }

TEST_F(Lockstep, OneAndFourRanksOfATinHashLikeTheirJournal) {
    expectOneHash(scene("[tin]\nmax_error = 0.001\nspacing = 0.02\n"), {{1, 1}, {2, 2}});
}

TEST_F(Lockstep, ThreadsInsideARankChangeNothing) {
    std::string expected;
    for (const std::string threads : {"1", "3"}) {
        const Ended ended =
            runToEnd({"--wall", wall(1, 2), "--scene", scene(), "--device", "script:gis", "--pace", "fast", "--steps",
                      "120", "--out", out(), "--no-pictures", "--sand-threads", threads});
        ASSERT_EQ(ended.status, 0) << ended.output;
        const std::string hash = summary()["state_hash"];
        expected = expected.empty() ? hash : expected;
        EXPECT_EQ(hash, expected) << threads << " threads";
    }
}

// With and without a hand: whoever numbers the steps takes the operator's wish into one of them.
TEST_F(Lockstep, AnOperatorSettlesTheSandOnEveryReplica) {
    for (const std::string device : {"script:gis", "none"}) {
        const auto session = start({"--wall", wall(1, 2), "--scene", scene(), "--device", device, "--steps", "100000",
                                    "--out", out(), "--no-pictures"});
        ASSERT_TRUE(session->waitForOutput(device == "none" ? "no hand" : "hand linked", 60)) << session->output();
        session->type("settle");
        session->type("dance");
        ASSERT_TRUE(session->waitForOutput("'dance' is no command; these are: status, pause", 30)) << session->output();
        std::this_thread::sleep_for(std::chrono::seconds(2));
        session->type("stop");
        EXPECT_EQ(session->wait(60), 0) << session->output();
        EXPECT_EQ(summary()["edits"], 1) << device;
        EXPECT_EQ(summary()["divergences"], 0);
        EXPECT_EQ(summary()["server_divergences"], 0);
        const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal --hash");
        EXPECT_EQ(replayed.output, summary()["state_hash"].get<std::string>() + "\n");
    }
}

TEST_F(Lockstep, ASessionLeavesItsPicturesAndItsFigures) {
    const Ended ended =
        runToEnd({"--wall", wall(2, 2), "--scene", scene(), "--device", "script:gis", "--steps", "60", "--out", out()});
    ASSERT_EQ(ended.status, 0) << ended.output;
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
    // A second of hand at 1 kHz: its middle period is a millisecond, or the loop was not there.
    EXPECT_GT(result["haptic_period_us"]["p50"].get<double>(), 0);
}

TEST_F(Lockstep, ARankThatSeesAnotherViewIsNamed) {
    const Ended ended = runToEnd({"--wall", wall(1, 3), "--scene", scene(), "--device", "script:gis", "--pace", "fast",
                                  "--steps", "100000", "--out", out(), "--skew-view", "rank=2,frame=20"});
    EXPECT_EQ(ended.status, 1) << ended.output;
    EXPECT_NE(ended.output.find("frame 20: rank 2 (tile r1c2) on " + host() + " drew another view of the wall"),
              std::string::npos)
        << ended.output;
    EXPECT_EQ(summary()["divergences"], 1);
}

TEST_F(Lockstep, TheWallGoesOnWhenTheHapticServerDies) {
    const auto session = start({"--wall", wall(1, 1), "--scene", scene(), "--device", "script:gis", "--out", out(),
                                "--steps", "600", "--no-pictures"});
    ASSERT_TRUE(session->waitForOutput("hand linked", 60)) << session->output();
    const auto server = support::findProgram(session->family(), "sandwall-haptic-server");
    ASSERT_TRUE(server.has_value());
    kill(*server, SIGKILL);
    EXPECT_TRUE(session->waitForOutput("the wall goes on without a hand", 30)) << session->output();
    EXPECT_EQ(session->wait(60), 0) << session->output();
    EXPECT_EQ(summary()["steps"], 600);
    EXPECT_EQ(summary()["divergences"], 0);
}

TEST_F(Lockstep, AHapticServerThatComesBackIsLinkedAgain) {
    const std::string sceneFile = scene();
    const auto serve = [&](const std::string& address) {
        return std::make_unique<support::ChildProcess>(
            std::vector<std::string>{SANDWALL_BIN_DIR "/sandwall-haptic-server", "--scene", sceneFile, "--device",
                                     "script:gis", "--listen", address, "--port-file", (folder_ / "port").string()},
            folder_ / "server.txt");
    };
    auto server = serve("127.0.0.1:0");
    ASSERT_TRUE(server->waitForOutput("listening on 127.0.0.1:", 20)) << server->output();
    const std::string address = "127.0.0.1:" + std::to_string(std::stoi(read("port")));
    const auto session = start({"--wall", wall(1, 1), "--scene", sceneFile, "--haptic", address, "--out", out(),
                                "--steps", "900", "--no-pictures"});
    ASSERT_TRUE(session->waitForOutput("linked, epoch 1 from step 1", 30)) << session->output();
    server->signal(SIGKILL);
    ASSERT_TRUE(session->waitForOutput("the wall goes on without a hand", 30)) << session->output();
    server = serve(address);
    EXPECT_TRUE(session->waitForOutput("linked, epoch 3", 30)) << session->output();
    EXPECT_EQ(session->wait(60), 0) << session->output();
    EXPECT_EQ(summary()["steps"], 900);
    EXPECT_EQ(summary()["server_divergences"], 0) << "the server went on from the wall's sand";
    EXPECT_EQ(summary()["haptic"]["reconnects"], 1);
}

TEST_F(Lockstep, AnAbsentServerIsNamedAndTheWallGoesOn) {
    const Ended ended = runToEnd({"--wall", wall(1, 1), "--scene", scene(), "--haptic", "127.0.0.1:1", "--out", out(),
                                  "--steps", "30", "--no-pictures"});
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("haptic link: nobody at 127.0.0.1:1 for 10 s; the wall goes on without a hand"),
              std::string::npos)
        << ended.output;
    EXPECT_EQ(summary()["steps"], 30);
}

TEST_F(Lockstep, AServerWithAnotherMaterialIsRefusedAndTheWallGoesOn) {
    const std::string other = write("other.toml", "name = \"test\"\n[field]\ncolumns = 128\n[terrain]\n[material]\n");
    const std::string portFile = (folder_ / "port").string();
    support::ChildProcess server({SANDWALL_BIN_DIR "/sandwall-haptic-server", "--scene", other, "--device",
                                  "script:gis", "--listen", "127.0.0.1:0", "--port-file", portFile},
                                 folder_ / "server.txt");
    ASSERT_TRUE(server.waitForOutput("listening on 127.0.0.1:", 20)) << server.output();
    const Ended ended = runToEnd({"--wall", wall(1, 1), "--scene", scene(), "--haptic",
                                  "127.0.0.1:" + std::to_string(std::stoi(read("port"))), "--out", out(), "--steps",
                                  "30", "--no-pictures"});
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("haptic link: refused; the wall goes on without a hand"), std::string::npos)
        << ended.output;
    EXPECT_EQ(summary()["steps"], 30);
}

}  // namespace
