// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace {

/// What is started again when something has died, and that the sand is the same.
class Recovery : public SessionTest {
protected:
    [[nodiscard]] std::string replayedHash() const {
        const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal --hash");
        EXPECT_EQ(replayed.status, 0) << replayed.output;
        return replayed.output.substr(0, replayed.output.find('\n'));
    }
    /// Runs a script of ours to its end, as runToEnd() runs a session.
    Ended script(const std::string& name, std::vector<std::string> arguments, double seconds) {
        arguments.insert(arguments.begin(), {"/usr/bin/env", "-u", "DISPLAY", SANDWALL_SOURCE_DIR "/scripts/" + name});
        support::ChildProcess process(arguments, folder_ / "output.txt");
        const std::optional<int> status = process.wait(seconds);
        EXPECT_TRUE(status.has_value()) << "still running after " << seconds << " s:\n" << process.output();
        return {status.value_or(-1), process.output()};
    }
};

TEST_F(Recovery, FiveRandomKillsLoseNothing) {
    // This seed: the server by ABRT, the master by ABRT, the server by TERM, a rank by KILL, and one that hangs. The
    // script compares what was shown with what came back, and the last hash with an undisturbed replay.
    const Ended ended = script("random_kills.py",
                               {"--kills", "5", "--seed", "337", "--wall", wall(1, 2, "mono"), "--scene", scene(),
                                "--out", out(), "--frame-timeout", "8"},
                               280);
    EXPECT_EQ(ended.status, 0) << ended.output << read("out/random_kills.log");
    EXPECT_NE(ended.output.find(" on the wall and of an undisturbed replay"), std::string::npos) << ended.output;
    EXPECT_EQ(summary()["recoveries"].size(), 3U);
}

TEST_F(Recovery, AMachineThatDiedGoesOnWhereItsJournalEnds) {
    const std::vector<std::string> arguments{"--wall",   wall(1, 2, "mono"), "--scene", scene(), "--out",      out(),
                                             "--device", "script:gis",       "--steps", "200",   "--restarts", "3"};
    const auto session = start(arguments);
    ASSERT_TRUE(session->waitForOutput("hand linked", 60)) << session->output();
    const std::vector<pid_t> family = session->family();
    for (const pid_t process : family) {
        kill(process, SIGKILL);
    }
    ASSERT_TRUE(support::waitUntilGone(family, 30).empty());
    EXPECT_FALSE(std::filesystem::exists(out() + "/summary.json"));
    std::vector<std::string> again = arguments;
    again.push_back("--resume");
    const Ended ended = runToEnd(again);
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_EQ(summary()["steps"], 200);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

TEST_F(Recovery, ARankThatDiesTooOftenIsNamedInTheReport) {
    const auto session = start({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--out", out(), "--restarts", "1",
                                "--restart-window", "600"});
    for (const char* shown : {"hashes agree", "first frame"}) {
        ASSERT_TRUE(session->waitForOutput(shown, 60)) << session->output();
        kill(support::findProgram(session->family(), "sandwall-render-node").value(), SIGBUS);
    }
    const std::vector<pid_t> family = session->family();
    EXPECT_EQ(session->wait(60), 1) << session->output();
    EXPECT_TRUE(support::waitUntilGone(family, 10).empty()) << "processes left running";
    const std::string report = read("out/log/report.txt");
    for (const char* word :
         {"the session is given up", " on ", "died of SIGBUS; shown: frame ", "End of error message"}) {
        EXPECT_NE(report.find(word), std::string::npos) << word << "\n" << report;
    }
}

TEST_F(Recovery, ASpareTakesThePlaceOfAHostThatIsCutOff) {
    const support::Ran probe = support::runCommand(
        "n=sandwall-probe-$$; ip netns add $n && ip netns exec $n unshare --uts true && "
        "ip -n $n link add veth0 type veth peer name veth1 && ip -n $n link add switch0 type bridge && "
        "tc -n $n qdisc add dev veth0 root tbf rate 1gbit burst 256kb latency 50ms; s=$?; ip netns delete $n; exit $s");
    if (probe.status != 0) {
        GTEST_SKIP() << "network namespaces need root, and a machine that allows them: " << probe.output;
    }
    const Ended ended = script("emulate_cluster.sh",
                               {"--out", out(), "--wall", wall(1, 2, "mono"), "--scene", scene(), "--spares", "1",
                                "--cut", "node02@1", "--", "--steps", "400", "--frame-timeout", "6", "--no-pictures"},
                               200);
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("rank 2 (tile r1c2) on node02 hung"), std::string::npos) << ended.output;
    EXPECT_NE(ended.output.find("spare node03 takes its place (rank 2)"), std::string::npos) << ended.output;
    EXPECT_EQ(summary()["per_rank"][0]["host"], "node01");
    EXPECT_EQ(summary()["per_rank"][1]["host"], "node03");
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["steps"], 400);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
    EXPECT_EQ(support::runCommand("ip netns list | grep -c ^sandwall-emulated-").output, "0\n") << "left behind";
}

}  // namespace
