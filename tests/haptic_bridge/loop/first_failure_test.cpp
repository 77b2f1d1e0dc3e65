// SPDX-License-Identifier: Apache-2.0
// When a thread of a server fails, the main thread learns it, and the hand is pushed with 0.
#include "haptic_bridge/loop/first_failure.hpp"

#include <gtest/gtest.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <stdexcept>

#include "haptic_bridge/loop/device_hand.hpp"
#include "haptic_bridge/loop/force_loop.hpp"
#include "haptic_bridge/server/sand_thread.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Vec3;

std::string lineOf(const FirstFailure& failure) {
    try {
        failure.rethrow();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(FirstFailure, IsTheOneThatTheMainThreadGets) {
    FirstFailure failure;
    int wakes = 0;
    failure.onFailure([&wakes] { ++wakes; });
    EXPECT_TRUE(failure.run("a thread", [] {}));
    EXPECT_EQ(lineOf(failure), "");
    EXPECT_FALSE(failure.run("the first", [] { throw std::runtime_error("no\npower"); }));
    EXPECT_FALSE(failure.run("the second", [] { throw 7; }));
    EXPECT_EQ(lineOf(failure), "the first has failed: no?power") << "one line";
    EXPECT_EQ(wakes, 1);
}

TEST(FirstFailure, MayBeAnyException) {
    FirstFailure failure;
    EXPECT_FALSE(failure.run("a driver", [] { throw 7; }));
    EXPECT_EQ(lineOf(failure), "a driver has failed: an exception without a text");
}

/// The forces of a hand. The force loop writes them, and the test reads them.
struct Pushed {
    std::atomic<double> last{-1};      // [N]
    std::atomic<bool> pressed{false};  // by a force above 0
    std::atomic<bool> refuses{false};  // whether the hand throws instead of taking a force
};

/// A hand in the middle of the field, half a radius deep in the sand.
class PressingHand : public Device {
public:
    explicit PressingHand(Pushed& pushed) : pushed_(pushed) {}
    [[nodiscard]] Pose read(double) override { return {0, 0, 0.5, true}; }
    void sendForce(Vec3 force) override {
        if (pushed_.refuses) {
            throw std::runtime_error("the device is gone");
        }
        pushed_.last = norm(force);
        pushed_.pressed = pushed_.pressed || norm(force) > 0;
    }
    [[nodiscard]] bool finished(double) const override { return false; }

private:
    Pushed& pushed_;
};

class LetGo : public testing::Test {
protected:
    const scene::Scene scene_ = samples::flatScene(60, 60);
    Pushed pushed_;
    std::unique_ptr<HapticTick> hand_ = std::make_unique<HapticTick>(
        scene_, std::make_unique<PressingHand>(pushed_), HandSettings::Datum::surface, Guards::Mode::literal);
    std::unique_ptr<HandChannel> channel_ = std::make_unique<HandChannel>();
};

TEST_F(LetGo, AHandThatIsDestroyedIsPushedWithZero) {
    VirtualHand hand(*hand_, *channel_, 60);
    hand.begin(sand::Replica(scene_));
    sand::Step step;
    hand.fill(step);
    ASSERT_GT(pushed_.last, 0);
    hand_.reset();
    EXPECT_EQ(pushed_.last, 0);
}

TEST_F(LetGo, ADeviceThatRefusesTheZeroEndsNothing) {
    pushed_.refuses = true;
    hand_.reset();
    EXPECT_EQ(pushed_.last, -1);
}

TEST_F(LetGo, AFailedSandThreadEndsTheServerWithZero) {
    boost::asio::io_context io;
    const auto busy = boost::asio::make_work_guard(io);
    channel_->failure.onFailure([&io] { io.stop(); });
    SandThread sandThread(
        sand::Replica(scene_), Pace::realtime, *hand_, *channel_,
        {[](std::uint32_t) {}, [](std::uint32_t, NeedState) {}, [](std::uint32_t, const std::string&) {},
         [this](std::uint32_t, const base::Bytes&, std::uint64_t) {
             if (pushed_.pressed) {
                 throw std::runtime_error("no memory for a step");
             }
         }});
    const std::atomic<bool> over{false};
    ForceLoop loop(*hand_, *channel_, "a hand", over);
    sandThread.start(1, {1, 0, sand::Replica(scene_).stateHash()});
    io.run();
    loop.stop();
    EXPECT_TRUE(pushed_.pressed);
    EXPECT_EQ(pushed_.last, 0);
    EXPECT_EQ(lineOf(channel_->failure), "the sand thread has failed: no memory for a step");
}

TEST_F(LetGo, AForceLoopPushesZeroWhenTheProcessIsAboutToBeKilled) {
    std::atomic<bool> over{false};
    const ForceLoop loop(*hand_, *channel_, "a hand", over);
    ChannelHand hand(*hand_, *channel_, 60);
    hand.begin(sand::Replica(scene_));
    ASSERT_TRUE(test::eventually([this] { return pushed_.last > 0; }));
    over = true;
    EXPECT_TRUE(test::eventually([this] { return pushed_.last == 0; }));
}

}  // namespace
