// SPDX-License-Identifier: Apache-2.0
// In these sessions the test itself is the haptic server, so it sees each message of the master.
#include <filesystem>

#include "master/journal/journal.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/haptic_bridge/client/sand_server.hpp"
#include "tests/support/processes/run_program.hpp"

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
    expectInOrder(*session);
    EXPECT_EQ(server.states(), 1) << "the server must get the wall's whole sand once";
    EXPECT_EQ(summary()["server_divergences"], 1);
    EXPECT_EQ(summary()["divergences"], 0) << "no rank has diverged";
    EXPECT_EQ(summary()["haptic"]["reconnects"], 1);
    EXPECT_EQ(summary()["haptic"]["hand_overs"]["by_state"], 1);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
    EXPECT_EQ(json("out/incidents.json")["server_divergences"], 1) << "a resumed session counts from this value";
}

TEST_F(WrongServer, WhoseMemoryHasChangedAtTheEndIsCountedAndNotHealed) {
    test::SandServer server(scene::loadScene(scene()));
    server.answerByeWith(haptic_bridge::Audited::differed);
    const auto session = startAt(server);
    ASSERT_FALSE(session->waitForEvent("link", {{"state", "linked"}}).is_null()) << session->output();
    awaitStatus([](const nlohmann::json& status) { return status.value("step", 0) > 10; });
    session->type("stop");
    EXPECT_TRUE(session->wait(kLong).has_value()) << session->output();
    const nlohmann::json told = summary();
    EXPECT_EQ(told["compared"]["at_end"], true) << "the wall's own sand was right";
    EXPECT_EQ(told["compared"]["server_at_end"], false);
    EXPECT_EQ(told["compared"]["first_difference"], told["frames"]);
    EXPECT_EQ(told["server_divergences"], 1);
    EXPECT_EQ(told["unhealed"], 1);
    EXPECT_EQ(json("out/incidents.json")["first_difference"], told["frames"]);
}

// The master sends the server the number of the last step that the wall shows. A shown step must be on disk.
TEST_F(WrongServer, SeesNoStepShownThatADiskHasFailedToSync) {
    constexpr std::size_t kFails = 40;  // calls of fdatasync before the one that fails; the first is the header's
    environment_ = {"LD_PRELOAD=" + support::linkTo("sync-log.so", folder_),
                    "SANDWALL_SYNC_LOG=" + (folder_ / "syncs").string(),
                    "SANDWALL_SYNC_FAILS=" + std::to_string(kFails + 1)};
    const test::SandServer server(scene::loadScene(scene()));
    const auto session = startAt(server);
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    const nlohmann::json failure = json("out/failure.json");
    EXPECT_TRUE(support::holds(failure, {{"what", "disk"}, {"rank", 0}, {"host", host()}, {"tile", ""}})) << failure;
    EXPECT_FALSE(session->waitForEvent("failure", {{"failure", failure}}).is_null()) << session->output();
    EXPECT_FALSE(std::filesystem::exists(out() + "/summary.json")) << "a session that fails must write no summary";
    const journal::Journal journal = master::readJournal(out() + "/session.journal");
    ASSERT_EQ(journal.frames.size(), kFails - 1) << "the journal must hold exactly the frames before the failed sync";
    EXPECT_EQ(journal.tornBytes, 0);
    EXPECT_GT(server.shown(), 0U);
    EXPECT_LE(server.shown(), journal.frames.back().steps.back().number);
    const std::string syncs = read("syncs");
    EXPECT_EQ(std::count(syncs.begin(), syncs.end(), '\n'), static_cast<std::ptrdiff_t>(kFails + 1));
    EXPECT_EQ(replayedHash().size(), 16U) << "the shown steps cannot be replayed";
}

}  // namespace
