// SPDX-License-Identifier: Apache-2.0
// Sessions whose haptic server is part of the test, so that the test sees each message of the master.
#include "scene/load/scene_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/haptic_bridge/client/sand_server.hpp"

namespace {

class WrongServer : public SessionTest {
protected:
    std::unique_ptr<support::ChildProcess> startAt(const test::SandServer& server) {
        return start({"--wall", wall(1, 1, "mono"), "--scene", scene(), "--haptic", server.address().text(), "--out",
                      out(), "--no-pictures"});
    }
};

TEST_F(WrongServer, WithOtherSandIsCountedAndStartsAgainFromTheWalls) {
    const test::SandServer server(scene::loadScene(scene()), [](int link, std::uint64_t step, std::uint64_t hash) {
        return link == 1 && step >= 60 ? hash ^ 1 : hash;
    });
    const auto session = startAt(server);
    ASSERT_FALSE(session->waitForEvent("link", {{"state", "linked"}, {"epoch", 1}}).is_null()) << session->output();
    EXPECT_FALSE(session->waitForEvent("without_hand", {{"reason", "other_sand"}, {"epoch", 2}}).is_null())
        << session->output();
    EXPECT_FALSE(session->waitForEvent("link", {{"state", "linked"}, {"epoch", 3}}).is_null()) << session->output();
    const int linked = ask("status")["step"];
    const nlohmann::json now =
        awaitStatus([&](const nlohmann::json& status) { return status.value("step", 0) > linked + 60; });
    EXPECT_EQ(now["server_divergences"], 1);
    EXPECT_EQ(now["linked"], true);
    session->type("stop");
    EXPECT_EQ(session->wait(kLong), 0) << session->output();
    EXPECT_EQ(server.states(), 1) << "it was given the wall's whole sand";
    EXPECT_EQ(summary()["server_divergences"], 1);
    EXPECT_EQ(summary()["divergences"], 0) << "no rank was wrong";
    EXPECT_EQ(summary()["haptic"]["reconnects"], 1);
    EXPECT_EQ(summary()["haptic"]["hand_overs"]["by_state"], 1);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
    EXPECT_EQ(json("out/incidents.json")["server_divergences"], 1) << "a session that goes on counts from there";
}

}  // namespace
