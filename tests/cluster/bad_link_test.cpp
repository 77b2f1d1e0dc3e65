// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

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
    ASSERT_FALSE(server.waitForEvent("listening").is_null()) << server.output();
    const impaired_link::ImpairedLink link(
        {.delayMs = 20, .jitterMs = 10, .stallShare = 0.02, .stallMs = 60, .resetAfter = 8'000, .seed = 4}, "127.0.0.1",
        static_cast<std::uint16_t>(std::stoi(read("port"))));
    const auto session = start({"--wall", wall(1, 2), "--scene", sceneFile, "--haptic",
                                "127.0.0.1:" + std::to_string(link.port()), "--out", out(), "--no-pictures"});
    // After the reset the wall makes the steps of epoch 2 by itself. On a busy machine the link may be back before the
    // master has noticed that it was lost. Epoch 2 is then that of the new link.
    const auto linkedAgain = [](const nlohmann::json& event) {
        return event.value("state", "") == "linked" && event.value("epoch", 0) >= 2;
    };
    const nlohmann::json again = session->waitForEvent("link", linkedAgain);
    ASSERT_FALSE(again.is_null()) << session->output();
    const auto alone = session->events("without_hand");
    const bool noticed = std::any_of(alone.begin(), alone.end(), [](const nlohmann::json& event) {
        return event.value("reason", "") == "lost" && event.value("epoch", 0) == 2;
    });
    EXPECT_EQ(again.value("epoch", 0), noticed ? 3 : 2) << session->output();
    const int linked = ask("status").value("step", 0);
    awaitStatus([&](const nlohmann::json& now) { return now.value("step", 0) >= linked + 60; });
    session->type("stop");
    expectInOrder(*session);
    EXPECT_EQ(link.resets(), 1);
    const nlohmann::json told = summary();
    EXPECT_EQ(told["divergences"], 0);
    EXPECT_EQ(told["server_divergences"], 0);
    EXPECT_EQ(told["haptic"]["reconnects"], 1);
    EXPECT_GT(told["haptic"]["half_round_trip_to_master_ms"]["count"], 0);
    EXPECT_GE(told["haptic"]["half_round_trip_to_master_ms"]["p50"], 20.0) << "half of the delay of both directions";
}

}  // namespace
