// SPDX-License-Identifier: Apache-2.0
#include "tests/cluster/session_fixture.hpp"
#include "tests/impaired_link/impaired_link.hpp"

namespace {

class BadLink : public SessionTest {};

TEST_F(BadLink, TheWallGoesOnOverDelayJitterStallsAndAReset) {
    const std::string sceneFile = scene();
    support::ChildProcess server(
        {(SANDWALL_BIN_DIR "/sandwall-haptic-server"), "--scene", sceneFile, "--device", "script:gis", "--timing-tests",
         "20", "--listen", "127.0.0.1:0", "--port-file", (folder_ / "port").string()},
        folder_ / "server.txt");
    ASSERT_TRUE(server.waitForOutput("listening on 127.0.0.1:", 20));
    const impaired_link::ImpairedLink link(
        {.delayMs = 20, .jitterMs = 10, .stallShare = 0.02, .stallMs = 60, .resetAfter = 8'000, .seed = 4}, "127.0.0.1",
        static_cast<std::uint16_t>(std::stoi(read("port"))));
    const Ended ended =
        runToEnd({"--wall", wall(1, 2), "--scene", sceneFile, "--haptic", "127.0.0.1:" + std::to_string(link.port()),
                  "--out", out(), "--steps", "240", "--no-pictures"});
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_EQ(link.resets(), 1);
    EXPECT_NE(ended.output.find("the wall goes on without a hand"), std::string::npos) << ended.output;
    EXPECT_NE(ended.output.find("linked, epoch 3"), std::string::npos) << "the hand goes on\n" << ended.output;
    const nlohmann::json told = summary();
    EXPECT_EQ(told["steps"], 240);
    EXPECT_EQ(told["divergences"], 0);
    EXPECT_EQ(told["server_divergences"], 0);
    EXPECT_EQ(told["haptic"]["reconnects"], 1);
    EXPECT_GT(told["haptic"]["half_round_trip_to_master_ms"]["count"], 0);
    EXPECT_GE(told["haptic"]["half_round_trip_to_master_ms"]["p50"], 20.0) << "the delay, there and back";
}

}  // namespace
