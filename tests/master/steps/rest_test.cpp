// SPDX-License-Identifier: Apache-2.0
// The master's own steps while sand and hand are at rest. The time is a clock that the test moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include "tests/master/steps/live_steps_fixture.hpp"

namespace {

using haptic_bridge::Pace;
using master::ArrivedStep;
using test::FakeServer;
using test::kFrameNs;

class RestTest : public test::LiveStepsTest {
protected:
    master::LiveSteps stepsOf(Pace pace = Pace::realtime, master::AtRest atRest = master::AtRest::makesNone,
                              const std::optional<haptic_bridge::Address>& server = std::nullopt) {
        return {server, scene_, asked_, pace, 0, {}, [this] { return nowNs_.load(); }, atRest};
    }
    /// Shows so many frames of a wall of 60 Hz, and returns how many steps they had.
    std::size_t showFrames(master::LiveSteps& live, int frames) {
        std::size_t steps = 0;
        for (int frame = 0; frame < frames; ++frame) {
            nowNs_ += kFrameNs;
            steps += show(live).size();
        }
        return steps;
    }
    /// Shows frames until no step is due, and then those of a minute.
    void restForAMinute(master::LiveSteps& live) {
        for (int frame = 0; frame < 600 && !live.rests(); ++frame) {
            showFrames(live, 1);
        }
        ASSERT_TRUE(live.rests());
        ASSERT_EQ(showFrames(live, 3600), 0U);
    }
    /// Reports the pointer at `x`, read `readNs` before the present time.
    void point(master::LiveSteps& live, std::int32_t x, bool pressed = false, std::int64_t readNs = 5'000'000) {
        haptic_bridge::PointerReport report;
        report.count = 1;
        report.pressed = pressed ? 1 : 0;
        report.touch = touches_ += pressed && !pressed_ ? 1 : 0;
        pressed_ = pressed;
        report.samples[0] = {nowNs_ - readNs, {x, 2048, 0}, static_cast<std::uint8_t>(pressed ? 1 : 0), 1, {}};
        live.pointed({&report, 1}, depth_, wall_, nowNs_);
    }
    /// Reports a pointer that has sent nothing since the frame before.
    void pointStill(master::LiveSteps& live) {
        haptic_bridge::PointerReport report;
        report.pressed = pressed_ ? 1 : 0;
        report.touch = touches_;
        live.pointed({&report, 1}, depth_, wall_, nowNs_);
    }

    double depth_ = 0.5;  // [tool radius]
    std::uint32_t touches_ = 0;
    bool pressed_ = false;
};

// The first step sweeps the level sand once, which finds it at rest. The second step has no sweep. From then on the
// sand has rested, and 60 frames of 1/60 s are the second.
TEST_F(RestTest, NoStepIsDueAfterTheSandHasRestedForASecond) {
    master::LiveSteps live = stepsOf();
    EXPECT_EQ(showFrames(live, 61), 61U);
    EXPECT_FALSE(live.rests());
    EXPECT_EQ(showFrames(live, 1), 0U);
    EXPECT_TRUE(live.rests());
    EXPECT_EQ(showFrames(live, 36'000), 0U) << "ten minutes";
    EXPECT_EQ(wall_.stepNumber(), 61U);
}

// 960 hash tiles count as moving for 30 steps, and 16 of them are sharpened in each step after these. The first step
// after the movement sharpens the first tiles.
TEST_F(RestTest, ALargeFieldGetsStepsUntilAllOfItIsDrawnAsAtRest) {
    const scene::Scene large = samples::flatScene(1024, 960);
    wall_ = sand::Replica(large);
    sand::StateCopy moved = wall_.copyState();
    sand::Movement movement = *wall_.surface().movement();
    movement.step = 1;
    std::ranges::fill(movement.moved, 1);
    base::ByteWriter numbers, head;
    movement.encode(numbers);
    moved.movement = numbers.take();
    std::memcpy(moved.head.data() + sizeof sand::kStateVersion, &movement.step, sizeof movement.step);
    wall_.decodeState(moved.encode());
    master::LiveSteps live(
        {}, large, asked_, Pace::realtime, 0, {}, [this] { return nowNs_.load(); }, master::AtRest::makesNone);
    for (int frame = 0; frame < 600 && !live.rests(); ++frame) {
        showFrames(live, 1);
    }
    EXPECT_EQ(wall_.stepNumber(), 1U + 30 + 960 / 16 - 1);
    EXPECT_EQ(showFrames(live, 600), 0U);
}

TEST_F(RestTest, ASessionOfCountedStepsAndAFastOneMakeThemAll) {
    master::LiveSteps counted = stepsOf(Pace::realtime, master::AtRest::makesSteps);
    EXPECT_EQ(showFrames(counted, 300), 300U);
    master::LiveSteps fast = stepsOf(Pace::fast);
    EXPECT_EQ(showFrames(fast, 300), 300U);
    EXPECT_FALSE(counted.rests() || fast.rests());
}

// The sweeps of a step with a large tool depend on whether it moves the tool. So the master must know how the step
// before it has left the tool, also if a slow wall takes several steps in a frame.
TEST_F(RestTest, NoStepIsLeftOutWhileAPointerTapsWithALargeTool) {
    scene::Scene large = samples::flatScene(128, 128, 20);
    large.rules.tuning.sweepsPerStep = 67;
    wall_ = sand::Replica(large);
    master::LiveSteps live(
        {}, large, asked_, Pace::realtime, 0, {}, [this] { return nowNs_.load(); }, master::AtRest::makesSteps);
    std::size_t most = 0;
    int engaged = 0;
    for (int frame = 0; frame < 60; ++frame) {
        nowNs_ += 3 * kFrameNs;
        const int x = 12000 + 300 * frame;
        point(live, x, false, 45'000'000);
        point(live, x + 100, frame % 3 == 0, 30'000'000);
        point(live, x + 200, frame % 6 == 0);
        const std::vector<ArrivedStep> steps = live.next(wall_, wall_.stateHash(), 4);
        for (const ArrivedStep& timed : steps) {
            wall_.apply(timed.step);
            ASSERT_EQ(wall_.leftOut(), "") << "frame " << frame;
            engaged += timed.step.engaged ? 1 : 0;
        }
        most = std::max(most, steps.size());
        live.shown({wall_.stepNumber(), 3 * kFrameNs});
    }
    EXPECT_GT(most, 1U) << "each frame had one step, so that the test shows nothing";
    EXPECT_GT(engaged, 10);
}

TEST_F(RestTest, SandThatSlidesIsNotAtRest) {
    master::LiveSteps live = stepsOf();
    restForAMinute(live);
    depth_ = 2;
    point(live, 2048, true);
    std::size_t moving = 0, steps = 0;  // steps until the last one that did something, and all of them
    do {
        nowNs_ += kFrameNs;
        steps += show(live).size();
        moving = wall_.lastWork() == sand::StepWork{} ? moving : steps;
        pointStill(live);
    } while (!live.rests() && steps < 3000);
    ASSERT_TRUE(live.rests());
    EXPECT_GT(moving, 1U) << "the press leaves sand that slides";
    EXPECT_TRUE(wall_.settled());
    EXPECT_TRUE(wall_.engaged()) << "a tool that is held where it is rests, too";
    EXPECT_GE(steps, moving + 59);
    EXPECT_LE(steps, moving + 62);
}

TEST_F(RestTest, AnEditIsInAStepOfTheNextFrame) {
    master::LiveSteps live = stepsOf();
    restForAMinute(live);
    asked_.add(sand::Edit::settle, {}, {});
    const std::vector<ArrivedStep> steps = show(live);
    ASSERT_EQ(steps.size(), 1U) << "and not those of the minute";
    EXPECT_EQ(steps[0].step.edit.number, 1U);
    EXPECT_FALSE(live.rests());
    const std::size_t more = showFrames(live, 300);
    EXPECT_GE(more, 59U);
    EXPECT_LE(more, 63U) << "the second until it rests again";
    EXPECT_TRUE(live.rests());
}

// A pointer that moves within a place of the sand sends samples, too. They are as old as the rest, and in no path.
TEST_F(RestTest, APointerThatMovesIsInAStepOfTheNextFrameWithThisMovementAlone) {
    master::LiveSteps live = stepsOf();
    point(live, 2048);
    restForAMinute(live);
    for (int frame = 0; frame < 50; ++frame) {  // less than a second, after which samples are dropped
        nowNs_ += kFrameNs;
        point(live, 2048);
        ASSERT_TRUE(show(live).empty()) << frame;
    }
    nowNs_ += kFrameNs;
    point(live, 2304);
    const std::int64_t read = nowNs_ - 5'000'000;
    const std::vector<ArrivedStep> steps = show(live);
    ASSERT_EQ(steps.size(), 1U);
    ASSERT_EQ(steps[0].step.path.size(), 1U);
    EXPECT_EQ(steps[0].step.path[0].x, 2304);
    EXPECT_EQ(steps[0].serverTimeNs, read) << "the latency is that of this movement";
    EXPECT_LE(showFrames(live, 1), 1U) << "the rest is no time that steps are due for";
}

TEST_F(RestTest, APressedPointerThatIsReleasedLiftsTheToolInTheNextFrame) {
    master::LiveSteps live = stepsOf();
    point(live, 2048, true);
    restForAMinute(live);
    ASSERT_TRUE(wall_.engaged());
    point(live, 2048, false);
    ASSERT_EQ(show(live).size(), 1U);
    EXPECT_FALSE(wall_.engaged());
}

TEST_F(RestTest, APausedSessionShowsTheMovementWhenItResumes) {
    master::LiveSteps live = stepsOf();
    point(live, 2048);
    restForAMinute(live);
    point(live, 2304);
    ASSERT_TRUE(show(live, 0).empty());
    nowNs_ += kFrameNs;
    pointStill(live);
    const std::vector<ArrivedStep> steps = show(live);
    ASSERT_EQ(steps.size(), 1U);
    ASSERT_EQ(steps[0].step.path.size(), 1U);
    EXPECT_EQ(steps[0].step.path[0].x, 2304);
}

// The server sends the same place again and again. It then presses there, and leaves.
TEST_F(RestTest, AServerWhoseHandStaysRestsAndItsToolIsLiftedWhenItLeaves) {
    std::atomic<bool> presses = false, leaves = false;
    std::atomic<int> sent = 0;
    FakeServer server(test::toTheFirst([&](FakeServer::Connection& connection) {
        connection.send(haptic_bridge::PositionGreeting{haptic_bridge::kProtocolVersion, "glove"});
        bool connected = true;
        for (; connected && !leaves; ++sent) {
            const bool pressed = presses;
            connected = connection.send(
                haptic_bridge::encode(haptic_bridge::Position{sent, 0.1, 0.2, pressed ? 0.5 : 1.5, pressed}));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }));
    master::LiveSteps live = stepsOf(Pace::realtime, master::AtRest::makesNone, server.address());
    ASSERT_TRUE(showUntil(live, [&] { return live.streaming(); }));
    const auto rests = [&] {
        for (int frame = 0; frame < 3000 && !live.rests(); ++frame) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            showFrames(live, 1);
        }
        return live.rests();
    };
    ASSERT_TRUE(rests());
    const std::uint64_t then = wall_.stepNumber();
    const int before = sent;
    ASSERT_TRUE(showUntil(live, [&] { return sent > before + 50; }));
    EXPECT_EQ(wall_.stepNumber(), then) << "positions have come meanwhile";
    presses = true;
    // A frame may come between positions of before the press and those of the press. Then the press is in the next
    // step.
    for (int frame = 0; frame < 3000 && !wall_.engaged(); ++frame) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        showFrames(live, 1);
    }
    ASSERT_TRUE(wall_.engaged());
    EXPECT_LE(wall_.stepNumber(), then + 2);
    ASSERT_TRUE(rests());
    EXPECT_TRUE(wall_.engaged());
    leaves = true;
    ASSERT_TRUE(showUntil(live, [&] { return !live.streaming(); }));
    showFrames(live, 2);
    EXPECT_FALSE(wall_.engaged()) << "no hand holds it any more";
}

}  // namespace
