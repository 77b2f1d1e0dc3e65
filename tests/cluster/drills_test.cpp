// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include "tests/cluster/session_fixture.hpp"

namespace {

/// Injected faults, and the reports that an operator gets of them.
class Drill : public SessionTest {
protected:
    /// Starts a session without a hand, with one injected fault. It would run for an hour.
    std::unique_ptr<support::ChildProcess> drill(const std::string& wallFile, const std::string& fault) {
        return start({"--wall", wallFile, "--scene", scene(), "--steps", "200000", "--out", out(), "--no-pictures",
                      "--frame-timeout", "2", "--inject", fault});
    }
    void expectNothingLeft(const std::vector<pid_t>& family) {
        EXPECT_TRUE(support::waitUntilGone(family, kLong).empty()) << "processes are still running";
    }
    [[nodiscard]] nlohmann::json failure() const { return json("out/failure.json"); }
};

TEST_F(Drill, AHungRankIsNamedAndTheJobEnds) {
    // There are four render ranks. The ranks that wait for the hung one know that they do not hang themselves.
    const auto session = drill(wall(2, 2, "mono"), "hang:rank=2,frame=30");
    const nlohmann::json waiting =
        session->waitForEvent("waiting", {{"frame", 30}, {"ranks", {2}}, {"ends_job", false}});
    ASSERT_FALSE(waiting.is_null()) << session->output();
    EXPECT_GE(waiting["seconds"], 1);
    const std::vector<pid_t> family = session->family();
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    expectNothingLeft(family);
    std::vector<nlohmann::json> endings = session->events("waiting");
    std::erase_if(endings, [](const nlohmann::json& event) { return !event["ends_job"]; });
    ASSERT_EQ(endings.size(), 1U) << "more than one process reported the end of the job\n" << session->output();
    EXPECT_TRUE(support::holds(endings[0], {{"by", 0}, {"frame", 30}, {"ranks", {2}}, {"limit", 2}})) << endings[0];
    EXPECT_GE(endings[0]["seconds"], 2);
    EXPECT_TRUE(support::holds(failure(), {{"what", "hung"}, {"rank", 2}, {"tile", "r1c2"}, {"host", host()}}))
        << failure();
}

TEST_F(Drill, ADeadRankEndsTheJobAndIsKeptFromDyingAgain) {
    const std::string fault = "die:rank=2,frame=30,signal=11";
    const auto session = drill(wall(1, 2, "mono"), fault);
    expectFrames(*session);
    const std::vector<pid_t> family = session->family();
    EXPECT_NE(session->wait(kLong).value_or(0), 0) << session->output();
    expectNothingLeft(family);
    EXPECT_FALSE(session->waitForEvent("drill", {{"frame", 30}, {"fault", fault}}).is_null()) << session->output();
    EXPECT_EQ(read("out/drills.done"), fault + "\n");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/failure.json")) << "the session gave up a rank";
}

// In frame 30 the noise has the length of an arrival, in frame 31 another length. In frame 32 it is too long for the
// master's buffer. tests/lockstep/barrier_test.cpp sends each of the three and expects that it is refused.
TEST_F(Drill, ARankThatSendsGarbageIsNamedAndGivenUp) {
    const auto session = drill(wall(1, 2, "mono"), "garbage:rank=2,frame=32");
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    EXPECT_FALSE(session->waitForEvent("failure", {{"failure", {{"what", "broken"}, {"rank", 2}}}}).is_null())
        << session->output();
    EXPECT_TRUE(support::holds(failure(), {{"what", "broken"}, {"rank", 2}, {"tile", "r1c2"}, {"host", host()}}))
        << failure();
    EXPECT_EQ(summary()["frames"], 32) << "the session did not end in order";
}

TEST_F(Drill, ARankThatIsSilentForAWhileIsNamedAndWaitedFor) {
    const Ended ended = runToEnd({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--frames", "40", "--out", out(),
                                  "--no-pictures", "--inject", "partition:rank=2,ms=2500,frame=30"});
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_TRUE(ended.has("waiting", {{"frame", 30}, {"ranks", {2}}, {"ends_job", false}})) << ended.output;
    EXPECT_FALSE(ended.has("waiting", {{"ends_job", true}})) << ended.output;
    EXPECT_EQ(summary()["frames"], 40);
    EXPECT_EQ(summary()["divergences"], 0);
}

TEST_F(Drill, AHapticLinkThatIsSilentOrGarbledComesBackByItself) {
    const std::string silent = "partition:ms=700,frame=30", garbled = "garbage:frame=90";
    const auto session = start({"--wall", wall(1, 1, "mono"), "--scene", scene(), "--device", "script:gis", "--out",
                                out(), "--no-pictures", "--inject", silent, "--inject", garbled});
    EXPECT_FALSE(session->waitForEvent("drill", {{"frame", 30}, {"fault", silent}}).is_null()) << session->output();
    EXPECT_FALSE(session->waitForEvent("drill", {{"frame", 90}, {"fault", garbled}}).is_null()) << session->output();
    EXPECT_FALSE(session->waitForEvent("without_hand", {{"reason", "lost"}}).is_null()) << session->output();
    EXPECT_FALSE(session->waitForEvent("link", {{"state", "linked"}, {"epoch", 3}}).is_null()) << session->output();
    session->signal(SIGINT);
    expectInOrder(*session);
    EXPECT_GE(summary()["haptic"]["reconnects"], 1);
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["server_divergences"], 0);
}

using FloatEnvironment = SessionTest;

// The driver changes the rounding of its rank at the start and in every frame (tests/support/machine/rough_driver.cpp).
TEST_F(FloatEnvironment, ADriverThatChangesItIsReportedAndTheSandStaysTheSame) {
    environment_ = {"LD_PRELOAD=" + support::linkTo("rough-driver.so", folder_), "SANDWALL_ROUGH_RANK=2",
                    "SANDWALL_EVENTS=1"};
    const Ended ended = runToEnd({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--device", "script:gis", "--pace",
                                  "fast", "--steps", "300", "--out", out(), "--no-pictures"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_TRUE(ended.has("floats", {{"rank", 2}})) << ended.output;
    EXPECT_FALSE(ended.has("floats", {{"rank", 1}})) << ended.output;
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["healed"], 0);
    EXPECT_EQ(summary()["steps"], 300);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

}  // namespace
