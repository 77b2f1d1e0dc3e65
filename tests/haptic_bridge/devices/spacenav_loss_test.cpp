// SPDX-License-Identifier: Apache-2.0
// A six-axis mouse that is lost while it digs: the daemon ends, hangs, or says that the mouse was unplugged.
#include <gtest/gtest.h>

#include "haptic_bridge/devices/spacenav.hpp"
#include "haptic_bridge/hand/device_troubles.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/haptic_bridge/devices/spacenav_daemon.hpp"
#include "tests/support/processes/server_process.hpp"

namespace {

using haptic_bridge::Pose;
using haptic_bridge::SpacenavDevice;

class SpacenavLoss : public testing::Test {
protected:
    void open() { device_.emplace(test::kSpnavLibrary); }
    /// Reads the device a millisecond of the hand later.
    Pose next() { return device_->read(time_ += 1e-3); }
    /// Pushes the cap to the east and presses the first button. Waits until the hand digs.
    void dig() {
        daemon_->push(350, 0, 0);
        daemon_->button(0, true);
        ASSERT_TRUE(test::eventually([&] {
            const double before = next().x;
            const Pose after = next();
            return after.engaged && after.x > before;
        }));
    }
    [[nodiscard]] bool isLifted() {
        return test::eventually([&] { return !next().engaged; });
    }
    [[nodiscard]] bool isBack() {
        return test::eventually([&] { return (void)next(), device_->reading().present; });
    }
    /// Expects that the hand stands still and is lifted for a second of its time.
    void expectStill() {
        const Pose from = next();
        for (int i = 0; i < 1000; ++i) {
            const Pose now = next();
            ASSERT_FALSE(now.engaged);
            ASSERT_EQ(now.x, from.x);
        }
    }
    [[nodiscard]] std::uint64_t losses() const { return device_->troubles()->losses(); }

    test::Folder folder_;
    std::optional<test::SpacenavDaemon> daemon_{std::in_place, folder_.file("spnav")};
    std::optional<SpacenavDevice> device_;
    double time_ = 0;
};

TEST_F(SpacenavLoss, ADaemonThatEndsStopsAndLiftsTheToolUntilItIsBack) {
    open();
    dig();
    daemon_->end();
    ASSERT_TRUE(isLifted());
    EXPECT_FALSE(device_->reading().present);
    EXPECT_TRUE(device_->troubles()->away());
    EXPECT_EQ(losses(), 1);
    expectStill();
    EXPECT_EQ(losses(), 1) << "counted once";
    const Pose left = next();
    daemon_->start();
    ASSERT_TRUE(isBack());
    EXPECT_FALSE(device_->troubles()->away());
    expectStill();
    EXPECT_EQ(next().x, left.x) << "the hand continues where it was";
    dig();
    EXPECT_EQ(losses(), 1);
}

// The daemon is back before the hand is read again.
TEST_F(SpacenavLoss, ADaemonThatRestartsAtOnceLiftsTheTool) {
    open();
    dig();
    daemon_->end();
    daemon_->start();
    ASSERT_TRUE(test::eventually([&] { return daemon_->links() == 2; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // in which the device takes the answer
    EXPECT_FALSE(next().engaged);
    EXPECT_EQ(losses(), 1);
    ASSERT_TRUE(isBack());
    expectStill();
    dig();
}

TEST_F(SpacenavLoss, ADaemonThatHangsStopsAndLiftsTheToolUntilItAnswers) {
    open();
    dig();
    daemon_->hang(true);
    ASSERT_TRUE(isLifted());
    EXPECT_EQ(losses(), 1);
    expectStill();
    daemon_->hang(false);
    ASSERT_TRUE(isBack()) << "it answers the question from before";
    expectStill();
    EXPECT_EQ(daemon_->clients(), 1) << "the link has stayed";
    dig();
}

// spacenavd sends an event only when the cap moves. A cap at its stop does not move.
TEST_F(SpacenavLoss, ACapThatIsHeldStillIsNotLost) {
    open();
    dig();
    const double from = next().x;
    const int asked = 2 * static_cast<int>(SpacenavDevice::kPatience / SpacenavDevice::kAskAfter);
    ASSERT_TRUE(test::eventually([&] { return next().engaged && daemon_->answers() >= asked; }));
    EXPECT_EQ(losses(), 0) << "after twice the time in which a daemon that hangs is lost";
    EXPECT_GT(next().x, from);
    daemon_->push(0, 0, 0);
    ASSERT_TRUE(test::eventually([&] {
        const double before = next().x;
        return next().x == before;
    }));
    ASSERT_TRUE(test::eventually([&, before = daemon_->answers()] { return daemon_->answers() > before; }))
        << "the button is still down";
    EXPECT_TRUE(next().engaged);
}

TEST_F(SpacenavLoss, AMouseAtRestIsNotAskedFor) {
    open();
    daemon_->push(350, 0, 0);
    ASSERT_TRUE(test::eventually([&] { return next().x > 0; }));
    daemon_->push(0, 0, 0);
    ASSERT_TRUE(test::eventually([&] {
        const double before = next().x;
        return next().x == before;
    }));
    const int before = daemon_->answers();
    std::this_thread::sleep_for(std::chrono::duration<double>(3 * SpacenavDevice::kAskAfter));
    EXPECT_LE(daemon_->answers(), before + 1) << "one question may have been on its way";
}

TEST_F(SpacenavLoss, ADaemonThatAnswersNoQuestionIsLostByItsSilenceWhileTheCapIsPushed) {
    daemon_.reset();
    daemon_.emplace(folder_.file("spnav"), 0);
    open();
    dig();
    ASSERT_TRUE(isLifted());
    EXPECT_EQ(losses(), 1);
    expectStill();
    daemon_->button(0, true);
    ASSERT_TRUE(test::eventually([&] { return next().engaged; })) << "any event brings it back";
    std::this_thread::sleep_for(std::chrono::duration<double>(1.2 * SpacenavDevice::kPatienceUnasked));
    EXPECT_TRUE(next().engaged) << "a button that is held at rest moves no sand";
    EXPECT_EQ(losses(), 1);
}

TEST_F(SpacenavLoss, AMouseThatIsUnpluggedStopsAndLiftsTheToolUntilItMoves) {
    open();
    dig();
    daemon_->unplug();
    ASSERT_TRUE(isLifted());
    EXPECT_EQ(losses(), 1);
    expectStill();
    dig();
    EXPECT_EQ(losses(), 1);
}

// The library takes the first word of the event for the answer. All packets after it would be out of step.
TEST_F(SpacenavLoss, AnEventBeforeTheAnswerIsNotTakenForIt) {
    daemon_->greetWithAnEvent(true);
    open();
    ASSERT_TRUE(test::eventually([&] { return daemon_->clients() >= 3; }));
    daemon_->greetWithAnEvent(false);
    ASSERT_TRUE(isBack());
    dig();
    const Pose from = next(), to = next();
    EXPECT_EQ(to.y, from.y);
    EXPECT_EQ(to.z, from.z);
}

TEST_F(SpacenavLoss, IsToldInALineAndTheServerReportsIt) {
    const std::string sceneFile = folder_.write("small.toml", test::kSmallScene);
    const scene::Scene scene = scene::loadScene(sceneFile);
    auto words = test::ServerProcess::usual(sceneFile, folder_, 0, "realtime");
    words[3] = "spacenav:" + test::kSpnavLibrary;
    test::ServerProcess server(folder_, words);
    haptic_bridge::Client client(server.address(), test::offerOf(scene));
    test::Wall wall(scene);
    const auto goesOn = [&] { return wall.follow(client, wall.replica.stepNumber() + 2); };
    ASSERT_TRUE(goesOn()) << client.link().message << "\n" << server.errors();
    daemon_->push(0, -350, 0);
    daemon_->button(0, true);
    ASSERT_TRUE(test::eventually([&] { return goesOn() && wall.replica.engaged(); }));
    daemon_->end();
    ASSERT_TRUE(test::eventually([&] { return goesOn() && !wall.replica.engaged(); }));
    const std::string device = "sandwall-haptic-server: device spacenav:" + test::kSpnavLibrary;
    const auto prints = [&](const std::string& line) {
        return test::eventually([&] { return goesOn() && server.errors().find(device + line) != std::string::npos; });
    };
    EXPECT_TRUE(prints(" does not answer; the tool is lifted")) << server.errors();
    daemon_->start();
    EXPECT_TRUE(prints(" answers again")) << server.errors();
    EXPECT_TRUE(test::eventually([&] {
        const auto report = client.report();
        return goesOn() && report && report->deviceLosses == 1 && !report->deviceAway;
    }));
    client.stop();
    EXPECT_EQ(server.stop(SIGTERM), 0) << server.errors();
}

}  // namespace
