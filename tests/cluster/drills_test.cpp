// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include "tests/cluster/session_fixture.hpp"

namespace {

/// Faults on purpose, and what an operator sees of them.
class Drill : public SessionTest {
protected:
    /// A session of two tiles without a hand, with one fault; it would run for an hour.
    std::unique_ptr<support::ChildProcess> drill(const std::string& fault) {
        return start({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--steps", "200000", "--out", out(),
                      "--no-pictures", "--frame-timeout", "2", "--inject", fault});
    }
    [[nodiscard]] std::string rankTwo() const { return "rank 2 (tile r1c2) on " + host(); }
    [[nodiscard]] nlohmann::json failure() const { return nlohmann::json::parse(read("out/failure.json")); }
};

TEST_F(Drill, AHungRankIsNamedAndTheJobEnds) {
    const auto session = drill("hang:rank=2,frame=30");
    EXPECT_TRUE(session->waitForOutput("frame 30 waits for " + rankTwo() + " for 1.", 60)) << session->output();
    const std::vector<pid_t> family = session->family();
    EXPECT_EQ(session->wait(60), 1) << session->output();
    EXPECT_TRUE(support::waitUntilGone(family, 10).empty()) << "processes left running";
    EXPECT_EQ(failure()["what"], "hung");
    EXPECT_EQ(failure()["rank"], 2);
    EXPECT_EQ(failure()["tile"], "r1c2");
    EXPECT_EQ(failure()["host"], host());
    EXPECT_NE(failure()["message"].get<std::string>().find("frame 30 waits for " + rankTwo() + " for 2."),
              std::string::npos)
        << failure();
}

TEST_F(Drill, ADeadRankEndsTheJobAndIsKeptFromDyingAgain) {
    const auto session = drill("die:rank=2,frame=30,signal=11");
    EXPECT_NE(session->wait(60).value_or(0), 0) << session->output();
    EXPECT_NE(session->output().find("drill in frame 30: die:rank=2,frame=30,signal=11"), std::string::npos)
        << session->output();
    EXPECT_EQ(read("out/drills.done"), "die:rank=2,frame=30,signal=11\n");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/failure.json")) << "nobody was given up";
}

// In frame 30 the noise has an arrival's length, in 31 another, and in 32 one for which there is no room.
TEST_F(Drill, ARankThatSendsGarbageIsNamedAndGivenUp) {
    const auto [frame, said] = std::pair{"32", "(far too long)"};
    const auto session = drill(std::string("garbage:rank=2,frame=") + frame);
    EXPECT_EQ(session->wait(60), 1) << session->output();
    const std::string line = std::string("frame ") + frame + ": " + rankTwo() + " sent what is no arrival";
    EXPECT_NE(session->output().find(line), std::string::npos) << session->output();
    EXPECT_NE(session->output().find(said), std::string::npos) << session->output();
    EXPECT_EQ(failure()["what"], "broken");
    EXPECT_EQ(failure()["rank"], 2);
    EXPECT_EQ(summary()["frames"], 32) << "an orderly end";
}

TEST_F(Drill, ARankThatIsSilentForAWhileIsNamedAndWaitedFor) {
    const Ended ended = runToEnd({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--frames", "40", "--out", out(),
                                  "--no-pictures", "--inject", "partition:rank=2,ms=1500,frame=30"});
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("frame 30 waits for " + rankTwo() + " for 1."), std::string::npos) << ended.output;
    EXPECT_EQ(summary()["frames"], 40);
    EXPECT_EQ(summary()["divergences"], 0);
}

TEST_F(Drill, AHapticLinkThatIsSilentOrGarbledComesBackByItself) {
    const auto session =
        start({"--wall", wall(1, 1, "mono"), "--scene", scene(), "--device", "script:gis", "--out", out(),
               "--no-pictures", "--inject", "partition:ms=700,frame=30", "--inject", "garbage:frame=120"});
    EXPECT_TRUE(session->waitForOutput("drill in frame 30: partition:ms=700,frame=30", 60)) << session->output();
    EXPECT_TRUE(session->waitForOutput("drill in frame 120: garbage:frame=120", 60)) << session->output();
    EXPECT_TRUE(session->waitForOutput("the wall goes on without a hand", 60)) << session->output();
    EXPECT_TRUE(session->waitForOutput("linked, epoch 3", 60)) << session->output();
    session->signal(SIGINT);
    EXPECT_EQ(session->wait(60), 0) << session->output();
    EXPECT_GE(summary()["haptic"]["reconnects"], 1);
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["server_divergences"], 0);
}

}  // namespace
