// SPDX-License-Identifier: Apache-2.0
// An arm holds its last force. On each orderly way out of the server, this force must be 0.
#include "haptic_bridge/server/parent_watch.hpp"
#include "tests/haptic_bridge/server/pressing_server.hpp"

namespace {

using namespace test;

class LastForce : public PressingServer {};

TEST_F(LastForce, IsZeroAfterAMasterThatLeavesAndASigterm) {
    ServerProcess server(folder_, words("none"));
    ASSERT_NO_FATAL_FAILURE(press(server.address()));
    client_->stop();
    EXPECT_EQ(server.stop(SIGTERM), 0) << server.errors();
    EXPECT_EQ(lastForce(), 0);
}

TEST_F(LastForce, IsZeroAfterASignalInTheMiddleOfATouch) {
    for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGHUP}) {
        ServerProcess server(folder_, words("none"));
        ASSERT_NO_FATAL_FAILURE(press(server.address()));
        EXPECT_EQ(server.stop(signal), 0) << server.errors();
        EXPECT_EQ(lastForce(), 0) << "signal " << signal;
    }
}

TEST_F(LastForce, IsZeroEvenIfMoreSignalsComeWhileTheServerEnds) {
    ServerProcess server(folder_, words("zero waits"));
    ASSERT_NO_FATAL_FAILURE(press(server.address()));
    breakDown();
    kill(server.pid(), SIGTERM);
    ASSERT_TRUE(logs("waits"));
    client_->stop();  // now the server waits for its arm alone
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        kill(server.pid(), signal);
    }
    EXPECT_GT(lastForce(), 0) << "the arm has not taken the 0 yet";
    (void)folder_.write("forces.go", "");
    EXPECT_EQ(server.wait(), 0) << server.errors();
    EXPECT_EQ(lastForce(), 0);
}

TEST_F(LastForce, IsZeroAfterAnExceptionOfTheDriver) {
    for (const auto& [fault, reason] : {std::pair{"read throws", "the cable?is out"},
                                        {"read throws 7", "an exception without a text"},
                                        {"push throws", "the motor is hot"}}) {
        std::filesystem::remove(folder_.file("forces.now"));
        ServerProcess server(folder_, words(fault));
        ASSERT_NO_FATAL_FAILURE(press(server.address()));
        breakDown();
        EXPECT_EQ(server.wait(), 1) << server.errors();
        EXPECT_EQ(lastForce(), 0) << fault;
        const std::string last =
            "sandwall-haptic-server: the force loop of device " + words(fault)[3] + " has failed: " + reason + "\n";
        EXPECT_TRUE(server.errors().ends_with(last)) << server.errors();
    }
}

TEST_F(LastForce, CannotBeZeroIfTheDriverThrowsForThatTooAndTheServerStillEndsWithALine) {
    ServerProcess server(folder_, words("push throws again"));
    ASSERT_NO_FATAL_FAILURE(press(server.address()));
    breakDown();
    EXPECT_EQ(server.wait(), 1) << server.errors();
    EXPECT_TRUE(server.errors().ends_with("has failed: the motor is hot\n")) << server.errors();
}

// The reader ends after the server's first line. A later line would bring SIGPIPE.
TEST_F(LastForce, IsZeroAlthoughNobodyReadsWhatTheServerPrints) {
    LaunchedServer server(folder_, words("none"), R"(mkfifo "$0.pipe"; read -r ignored < "$0.pipe" &
"$@" > "$0.pipe" 2>&1 & echo $! > "$0"; wait)");
    ASSERT_NO_FATAL_FAILURE(press(server.address()));
    server.killLauncher();
    EXPECT_EQ(server.wait(), 0);
    EXPECT_EQ(lastForce(), 0);
}

TEST_F(LastForce, IsZeroAfterTheLauncherWasKilled) {
    LaunchedServer server(folder_, words("none"));
    ASSERT_NO_FATAL_FAILURE(press(server.address()));
    server.killLauncher();
    EXPECT_EQ(server.wait(), 0) << folder_.read("pid.err");
    EXPECT_EQ(lastForce(), 0);
}

TEST_F(LastForce, IsZeroAfterTheLauncherOfAStoppedServerWasKilled) {
    LaunchedServer server(folder_, words("none"));
    ASSERT_NO_FATAL_FAILURE(press(server.address()));
    kill(server.pid(), SIGSTOP);
    server.killLauncher();
    EXPECT_EQ(server.wait(), 0) << folder_.read("pid.err");
    EXPECT_EQ(lastForce(), 0);
}

TEST_F(LastForce, IsZeroAfterTheLauncherOfAHungMainThreadWasKilled) {
    LaunchedServer server(folder_, words("main hangs"));
    ASSERT_NO_FATAL_FAILURE(press(server.address()));
    breakDown();
    ASSERT_TRUE(logs("hangs"));
    server.killLauncher();
    EXPECT_EQ(server.wait(), -SIGKILL) << folder_.read("pid.err");
    EXPECT_EQ(lastForce(), 0);
}

TEST_F(LastForce, OfADriverThatHangsIsHeldAndTheServerStillEndsAfterItsLauncher) {
    LaunchedServer server(folder_, words("read hangs"));
    ASSERT_NO_FATAL_FAILURE(press(server.address()));
    breakDown();
    ASSERT_TRUE(logs("hangs"));
    server.killLauncher();
    EXPECT_EQ(server.wait(), -SIGKILL) << folder_.read("pid.err");
}

class ParentWatch : public testing::Test {
protected:
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

/// A process whose parent has ended before the watch begins, so that its parent is another now.
[[noreturn]] void outlive() {
    haptic_bridge::endWithParent(getppid() + 1, std::chrono::milliseconds(50));
    while (true) {
        pause();
    }
}

TEST_F(ParentWatch, EndsAProcessWhoseParentHasEndedBefore) {
    EXPECT_EXIT(outlive(), testing::KilledBySignal(SIGTERM), "");
}

TEST_F(ParentWatch, KillsAProcessThatDoesNotEndByItself) {
    EXPECT_EXIT((signal(SIGTERM, SIG_IGN), outlive()), testing::KilledBySignal(SIGKILL), "");
}

/// Begins an hour of patience and waits up to `seconds`.
[[noreturn]] void outliveFor(unsigned seconds) {
    signal(SIGTERM, SIG_IGN);
    haptic_bridge::endWithParent(getppid() + 1, std::chrono::hours(1));
    for (unsigned left = seconds; left > 0;) {
        left = sleep(left);
    }
    std::_Exit(7);
}

TEST_F(ParentWatch, HasLessPatienceWithAProcessThatStarts) {
    EXPECT_EXIT(outliveFor(60), testing::KilledBySignal(SIGKILL), "");
    EXPECT_EXIT((haptic_bridge::startIsOver(), outliveFor(2)), testing::ExitedWithCode(7), "");
}

}  // namespace
