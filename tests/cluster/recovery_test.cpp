// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <regex>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

/// A process is killed and started again. The sand must stay the same.
class Recovery : public SessionTest {
protected:
    /// Runs a script of scripts/checks to its end, as runToEnd() runs a session.
    Ended script(const std::string& name, std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(),
                         {"/usr/bin/env", "-u", "DISPLAY", SANDWALL_SOURCE_DIR "/scripts/checks/" + name});
        support::ChildProcess process(arguments, folder_ / "output.txt");
        const std::optional<int> status = process.wait(kLongScript);
        EXPECT_TRUE(status.has_value()) << "still running after " << kLongScript << " s:\n" << process.output();
        return {status.value_or(-1), process.output()};
    }
    /// Waits until the session has written `count` events of this name, and has shown steps after the last one.
    static void expectSteps(support::ChildProcess& session, const std::string& event, std::size_t count) {
        EXPECT_TRUE(session.waitUntil([&] { return session.events(event).size() >= count; })) << session.output();
        const std::size_t before = session.events("progress").size();
        EXPECT_TRUE(session.waitUntil([&] {
            const std::vector<nlohmann::json> all = session.events("progress");
            return all.size() > before && all.back()["step"] > 0;
        })) << session.output();
    }
    static void strike(const support::ChildProcess& session, const std::string& program, int signal) {
        kill(support::findProgram(session.family(), program).value(), signal);
    }

    static constexpr double kLongScript = 300;  // [s]
};

TEST_F(Recovery, KillsOfEveryProcessLoseNothing) {
    const auto session =
        start({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--device", "script:gis", "--out", out(),
               "--no-pictures", "--frame-timeout", "4", "--restarts", "100000", "--restart-window", "0.001"});
    expectSteps(*session, "link", 1);
    // On a busy machine a frame may be so late that the job is started again. So there may be more recoveries.
    int lastShown = 0;
    for (const auto& [program, signal] : {std::pair{"sandwall-master", SIGABRT},
                                          {"sandwall-render-node", SIGKILL},
                                          {"sandwall-render-node", SIGSTOP}}) {
        SCOPED_TRACE(std::string(program) + ", signal " + std::to_string(signal));
        const std::size_t recovered = session->events("recovered").size();
        lastShown = std::max(lastShown, session->events("progress").back()["step"].get<int>());
        strike(*session, program, signal);
        expectSteps(*session, "recovered", recovered + 1);
        const nlohmann::json recovery = session->events("recovered").back()["recovery"];
        EXPECT_GE(recovery["step"], lastShown) << "shown steps were lost";
    }
    const auto links = [&] {
        const std::vector<nlohmann::json> all = session->events("link");
        return static_cast<std::size_t>(std::count_if(
            all.begin(), all.end(), [](const nlohmann::json& event) { return event["state"] == "linked"; }));
    };
    EXPECT_TRUE(session->waitUntil([&] { return session->events("progress").back()["hand"] == "hand linked"; }))
        << session->output();
    const std::size_t before = links();
    strike(*session, "sandwall-haptic-server", SIGTERM);
    EXPECT_TRUE(session->waitUntil([&] { return links() > before; })) << session->output();
    session->signal(SIGINT);
    expectInOrder(*session);
    EXPECT_GE(summary()["recoveries"].size(), 3U);
    EXPECT_GE(summary()["steps"], lastShown);
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
    const std::string journal = read("out/session.journal");
    EXPECT_TRUE(std::regex_search(journal, std::regex("rank [0-2]: SIG(ABRT|KILL)"))) << "it has the failures";
    EXPECT_EQ(journal.find(" on "), std::string::npos) << "a journal names no host, as in: rank 1 on node01";
    EXPECT_EQ(journal.find(folder_.string()), std::string::npos) << "a journal names no folder";
}

// Whether there is memory depends on the host. So a rank without memory for a step must end, and not leave the step
// out.
TEST_F(Recovery, ARankWithoutMemoryEndsAndTheSessionGoesOn) {
    const std::string field = scene();
    write("scene.toml", std::regex_replace(read("scene.toml"), std::regex("128"), "1024"));
    const auto session = start({"--wall", wall(1, 2, "mono"), "--scene", field, "--out", out(), "--no-pictures",
                                "--restarts", "100000", "--restart-window", "0.001"});
    expectFrames(*session);
    ask("save level");
    // The rank keeps the memory that it has, which is too little for other heights.
    const rlimit none{1, 1};
    const pid_t rank = support::findProgram(session->family(), "sandwall-render-node").value();
    ASSERT_EQ(prlimit(rank, RLIMIT_AS, &none, nullptr), 0);
    (void)answer("load level");  // the session may end before it answers
    expectSteps(*session, "recovered", 1);
    session->signal(SIGINT);
    expectInOrder(*session);
    EXPECT_GE(summary()["recoveries"].size(), 1U);
    EXPECT_EQ(summary()["steps_left_out"], 0);
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

// The link ends after ten seconds of silence, and the server's process after ten more.
TEST_F(Recovery, AHapticServerThatHangsIsKilledAndStartedAgain) {
    const auto session = start({"--wall", wall(1, 1, "mono"), "--scene", scene(), "--device", "script:gis", "--out",
                                out(), "--no-pictures", "--restarts", "3"});
    expectHand(*session);
    expectSteps(*session, "link", 1);
    strike(*session, "sandwall-haptic-server", SIGSTOP);
    ASSERT_FALSE(session->waitForEvent("without_hand", {{"reason", "lost"}, {"epoch", 2}}).is_null())
        << session->output();
    EXPECT_EQ(session->events("restart").size(), 0U) << "the wall must continue before the server is restarted";
    EXPECT_GT(ask("settle")["step"], 0) << "the master numbers the steps";
    EXPECT_EQ(ask("status")["linked"], false);
    EXPECT_FALSE(session->waitForEvent("restart", {{"rank", nullptr}, {"how", "hung"}, {"count", 1}}).is_null())
        << session->output();
    EXPECT_FALSE(session->waitForEvent("link", {{"state", "linked"}, {"epoch", 3}}).is_null()) << session->output();
    const int linked = ask("status")["step"];
    // The report is not good if the hand felt stale sand for half of the time. On a loaded machine a frame may take a
    // second.
    awaitStatus([&](const nlohmann::json& now) { return now.value("step", 0) > linked + 150; });
    session->signal(SIGINT);
    expectInOrder(*session);
    EXPECT_EQ(summary()["haptic"]["reconnects"], 1);
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["server_divergences"], 0);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

// The script that operators run for an hour checks itself. Its exit status shows whether anything was lost.
TEST_F(Recovery, ARandomKillLosesNothing) {
    const Ended ended = script(
        "random_kills.py", {"--kills", "1", "--victims", "rank,master", "--signals", "KILL,SEGV", "--seed", "337",
                            "--wall", wall(1, 2, "mono"), "--scene", scene(), "--out", out(), "--frame-timeout", "30"});
    EXPECT_EQ(ended.status, 0) << ended.output << read("out/random_kills.log");
    EXPECT_GE(summary()["recoveries"].size(), 1U);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

// The script tries every process, signal and moment of a large start. Here it tries a few of a small one.
TEST_F(Recovery, AProcessThatIsKilledDuringTheStartLeavesNothing) {
    const Ended ended =
        script("kill_starts.py", {"--side", "200", "--wall", wall(1, 2, "mono"), "--limit", "100", "--processes",
                                  "launcher", "master", "--signals", "KILL", "--moments", "rank"});
    // The status is 1 if no try was made. On a busy machine, a try may come after the first frame, and is then left
    // out.
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("\n0 of "), std::string::npos) << ended.output;
}

TEST_F(Recovery, AMachineThatDiedGoesOnWhereItsJournalEnds) {
    const std::vector<std::string> arguments{"--wall", wall(1, 2, "mono"), "--scene",    scene(),         "--out",
                                             out(),    "--device",         "script:gis", "--no-pictures", "--restarts",
                                             "3"};
    const auto session = start(arguments);
    const nlohmann::json shown = session->waitForEvent(
        "progress", [](const auto& event) { return event["hand"] == "hand linked" && event["step"] > 30; });
    ASSERT_FALSE(shown.is_null()) << session->output();
    const std::vector<pid_t> family = session->family();
    for (const pid_t process : family) {
        kill(process, SIGKILL);
    }
    ASSERT_TRUE(support::waitUntilGone(family, kLong).empty());
    EXPECT_FALSE(std::filesystem::exists(out() + "/summary.json"));
    std::vector<std::string> again = arguments;
    again.insert(again.end(), {"--resume", "--pace", "fast", "--steps", "1000"});
    const Ended ended = runToEnd(again);
    EXPECT_EQ(ended.status, 0) << ended.output;
    const std::vector<nlohmann::json> resumed = support::eventsIn(ended.output, "resumed");
    ASSERT_EQ(resumed.size(), 1U) << ended.output;
    EXPECT_GE(resumed[0]["step"], shown["step"]) << "shown steps were not on the disk";
    EXPECT_EQ(summary()["steps"], 1000);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

TEST_F(Recovery, ARankThatDiesTooOftenIsNamedInTheReport) {
    const auto session = start({"--wall", wall(1, 1, "mono"), "--scene", scene(), "--out", out(), "--restarts", "1",
                                "--restart-window", "600"});
    for (const char* shown : {"progress", "recovered"}) {
        ASSERT_FALSE(session->waitForEvent(shown).is_null()) << session->output();
        strike(*session, "sandwall-render-node", SIGBUS);
    }
    const std::vector<pid_t> family = session->family();
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    EXPECT_TRUE(support::waitUntilGone(family, kLong).empty()) << "processes are still running";
    EXPECT_FALSE(
        session->waitForEvent("restart", {{"rank", 1}, {"how", "SIGBUS"}, {"count", 1}, {"limit", 1}}).is_null())
        << session->output();
    const nlohmann::json givenUp = session->waitForEvent("given_up");
    ASSERT_FALSE(givenUp.is_null()) << session->output();
    ASSERT_EQ(givenUp["failures"].size(), 2U) << givenUp;
    for (const nlohmann::json& failure : givenUp["failures"]) {
        EXPECT_EQ(failure["rank"], 1) << failure;
        EXPECT_GE(failure["frame"], 1) << failure;
        EXPECT_EQ(failure["how"], "SIGBUS") << failure;
    }
    const std::string report = read("out/log/report.txt");
    EXPECT_NE(report.find("SIGBUS"), std::string::npos) << report;
    EXPECT_NE(report.find(host()), std::string::npos) << report;
}

TEST_F(Recovery, ASpareTakesThePlaceOfAHostThatIsCutOff) {
    if (support::runCommand(SANDWALL_SOURCE_DIR "/scripts/checks/emulate_cluster.sh --check").status != 0) {
        GTEST_SKIP() << "this machine does not allow network namespaces, neither for root nor in a user namespace";
    }
    const Ended ended = script("emulate_cluster.sh",
                               {"--out", out(), "--wall", wall(1, 2, "mono"), "--scene", scene(), "--spares", "1",
                                "--cut", "node02@1", "--", "--steps", "240", "--frame-timeout", "5", "--no-pictures"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_TRUE(ended.has("restart", {{"rank", 2}, {"how", "hung"}})) << ended.output;
    EXPECT_TRUE(ended.has("spare", {{"host", "node02"}, {"spare", "node03"}, {"ranks", {2}}})) << ended.output;
    EXPECT_EQ(summary()["per_rank"][0]["host"], "node01");
    EXPECT_EQ(summary()["per_rank"][1]["host"], "node03");
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["steps"], 240);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
    EXPECT_EQ(support::runCommand("ip netns list | grep -c ^sandwall-emulated-").output, "0\n")
        << "network namespaces were left behind";
}

}  // namespace
