// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace {

/// How sessions end, wanted or not: nothing hangs, nothing is left running.
class Ending : public SessionTest {
protected:
    /// A session that would run for minutes, in its third second or so.
    std::unique_ptr<support::ChildProcess> runningSession() {
        auto session = start({"--wall", wall(2, 2), "--scene", scene(), "--device", "script:gis", "--steps", "100000",
                              "--out", out(), "--frame-timeout", "3"});
        EXPECT_TRUE(session->waitForOutput("hand linked", 60)) << session->output();
        family_ = session->family();
        EXPECT_GE(family_.size(), 8U) << "launcher, server, mpirun, master and four ranks";
        return session;
    }
    void expectNothingLeft(double seconds) {
        EXPECT_TRUE(support::waitUntilGone(family_, seconds).empty()) << "processes left running";
    }
    std::vector<pid_t> family_;
};

TEST_F(Ending, CtrlCLeavesJournalAndSummaryWhole) {
    const auto session = runningSession();
    session->signal(SIGINT);
    EXPECT_EQ(session->wait(60), 0) << session->output();
    expectNothingLeft(5);
    const std::string hash = summary()["state_hash"];
    const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal --hash");
    EXPECT_EQ(replayed.output, hash + "\n");
    EXPECT_TRUE(std::filesystem::exists(out() + "/wall_anaglyph.png"));
}

TEST_F(Ending, AKilledLauncherEndsTheSessionInOrder) {
    const auto session = runningSession();
    session->signal(SIGKILL);
    expectNothingLeft(30);
    EXPECT_EQ(summary()["divergences"], 0) << "the master saw its input end and finished its work";
}

TEST_F(Ending, AKilledMpirunLeavesNothingRunning) {
    const auto session = runningSession();
    kill(support::findProgram(family_, "mpirun").value(), SIGKILL);
    EXPECT_NE(session->wait(30).value_or(0), 0) << session->output();
    expectNothingLeft(5);
    const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal --hash");
    EXPECT_EQ(replayed.status, 0) << "what was on disk is whole: " << replayed.output;
}

TEST_F(Ending, AKilledRankEndsTheJob) {
    const auto session = runningSession();
    kill(support::findProgram(family_, "sandwall-render-node").value(), SIGKILL);
    EXPECT_NE(session->wait(30).value_or(0), 0) << session->output();
    expectNothingLeft(5);
}

/// How many lines say that they end the job.
std::size_t endings(const std::string& output) {
    std::size_t count = 0;
    for (auto at = output.find("ending the job"); at != std::string::npos; at = output.find("ending the job", at + 1)) {
        ++count;
    }
    return count;
}

TEST_F(Ending, AStoppedRankIsNamedAndTheJobEnds) {
    // Still sand and no hand: the ranks wait most of the time, and stop in the middle of waiting.
    const auto session = start({"--wall", wall(2, 2, "mono"), "--scene", scene(), "--steps", "100000", "--out", out(),
                                "--frame-timeout", "3"});
    ASSERT_TRUE(session->waitForOutput("hashes agree", 60)) << session->output();
    family_ = session->family();
    std::vector<pid_t> nodes;
    for (const pid_t process : family_) {
        if (support::findProgram({process}, "sandwall-render-node")) {
            nodes.push_back(process);
        }
    }
    ASSERT_EQ(nodes.size(), 4U);
    std::sort(nodes.begin(), nodes.end());  // mpirun starts them in the order of ranks
    kill(nodes[2], SIGSTOP);
    EXPECT_TRUE(session->waitForOutput("waits for rank 3 (tile r2c1) on " + host() + " for 1.", 10))
        << session->output();
    EXPECT_EQ(session->wait(30), 1) << session->output();
    EXPECT_NE(session->output().find("waits for rank 3 (tile r2c1) on " + host() + " for 3."), std::string::npos)
        << session->output();
    EXPECT_EQ(endings(session->output()), 1U) << session->output();
    expectNothingLeft(5);
}

TEST_F(Ending, AStoppedMasterIsNamedAndTheJobEnds) {
    const auto session = runningSession();
    kill(support::findProgram(family_, "sandwall-master").value(), SIGSTOP);
    EXPECT_NE(session->wait(30).value_or(0), 0) << session->output();
    EXPECT_NE(session->output().find("rank 1 waits for the master after frame"), std::string::npos)
        << session->output();
    EXPECT_EQ(endings(session->output()), 1U) << session->output();
    expectNothingLeft(10);
}

TEST_F(Ending, ASecondCtrlCKills) {
    const auto session = runningSession();
    kill(support::findProgram(family_, "sandwall-master").value(), SIGSTOP);
    session->signal(SIGINT);
    ASSERT_TRUE(session->waitForOutput("once more to kill", 10)) << session->output();
    session->signal(SIGINT);
    EXPECT_TRUE(session->wait(20).has_value()) << session->output();
    expectNothingLeft(10);
}

}  // namespace
