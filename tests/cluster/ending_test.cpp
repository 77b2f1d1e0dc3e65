// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/mpirun.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

/// Intended and unintended ends of sessions. Each session must end, and no process may be left running.
class Ending : public SessionTest {
protected:
    /// Starts a session that would run for minutes, with a hand in its sand. A rank that is missing for longer than
    /// `limit` [s] ends it; the usual limit is longer than any frame takes on a busy machine.
    std::unique_ptr<support::ChildProcess> runningSession(int limit = 30) {
        auto session = start({"--wall", wall(2, 2), "--scene", scene(), "--device", "script:gis", "--steps", "100000",
                              "--out", out(), "--frame-timeout", std::to_string(limit)});
        expectFrames(*session);
        expectHand(*session);
        family_ = session->family();
        EXPECT_GE(family_.size(), 8U) << "expected launcher, server, mpirun, master and four ranks";
        return session;
    }
    void expectNothingLeft() {
        EXPECT_TRUE(support::waitUntilGone(family_, kLong).empty()) << "processes are still running";
    }
    std::vector<pid_t> family_;
};

TEST_F(Ending, CtrlCLeavesJournalAndSummaryWhole) {
    const auto session = runningSession();
    session->signal(SIGINT);
    expectInOrder(*session);
    EXPECT_FALSE(session->waitForEvent("stopping").is_null()) << session->output();
    expectNothingLeft();
    EXPECT_EQ(summary()["state_hash"], replayedHash());
    EXPECT_TRUE(std::filesystem::exists(out() + "/wall_anaglyph.png"));
}

TEST_F(Ending, AKilledLauncherEndsTheSessionInOrder) {
    const auto session = runningSession();
    session->signal(SIGKILL);
    expectNothingLeft();
    EXPECT_EQ(summary()["divergences"], 0) << "the master must end in order when its input ends";
}

TEST_F(Ending, AKilledMpirunLeavesNothingRunning) {
    const auto session = runningSession();
    kill(support::findProgram(family_, support::mpirunProcess()).value(), SIGKILL);
    EXPECT_NE(session->wait(kLong).value_or(0), 0) << session->output();
    expectNothingLeft();
    const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal --hash");
    EXPECT_EQ(replayed.status, 0) << "the part of the journal on disk is damaged: " << replayed.output;
}

TEST_F(Ending, AStoppedMasterIsNamedAndTheJobEnds) {
    const auto session = runningSession(10);
    kill(support::findProgram(family_, "sandwall-master").value(), SIGSTOP);
    EXPECT_NE(session->wait(kLong).value_or(0), 0) << session->output();
    std::vector<nlohmann::json> endings = session->events("waiting");
    std::erase_if(endings, [](const nlohmann::json& event) { return !event["ends_job"]; });
    ASSERT_EQ(endings.size(), 1U) << "more than one rank reported the end of the job\n" << session->output();
    EXPECT_TRUE(support::holds(endings[0], {{"by", 1}, {"ranks", {0}}, {"limit", 10}})) << endings[0];
    EXPECT_GE(endings[0]["seconds"], 10);
    expectNothingLeft();
}

TEST_F(Ending, ASecondCtrlCKills) {
    const auto session = runningSession();
    kill(support::findProgram(family_, "sandwall-master").value(), SIGSTOP);
    session->signal(SIGINT);
    ASSERT_FALSE(session->waitForEvent("stopping").is_null()) << session->output();
    session->signal(SIGINT);
    EXPECT_TRUE(session->wait(kLong).has_value()) << session->output();
    expectNothingLeft();
}

}  // namespace
