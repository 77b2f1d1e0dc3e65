// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/device_hand.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "haptic_bridge/devices/mapped_device.hpp"
#include "haptic_bridge/loop/felt_sand.hpp"
#include "tests/haptic_bridge/devices/fake_arm.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;

/// A hand in the middle of the field. It remembers the times at which it was read.
class ClockedHand : public Device {
public:
    explicit ClockedHand(std::vector<double>& times) : times_(times) {}
    [[nodiscard]] Pose read(double time) override {
        times_.push_back(time);
        return {0, 0, 0.5, true};
    }
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] bool finished(double) const override { return false; }

private:
    std::vector<double>& times_;
};

class DeviceHandTest : public testing::Test {
protected:
    [[nodiscard]] static sand::Step nextStep(DeviceHand& hand) {
        sand::Step step;
        hand.fill(step);
        return step;
    }
    const scene::Scene scene_ = samples::flatScene(60, 60);
    const sand::Replica sand_{scene_};
    std::vector<double> times_;
    HapticTick hand_{scene_, std::make_unique<ClockedHand>(times_), HandSettings::Datum::surface};
    std::unique_ptr<HandChannel> channel_ = std::make_unique<HandChannel>();
};

// 1000/60 ms per step: steps have 16, 17 and 17 ticks, and each tick is read exactly once.
TEST_F(DeviceHandTest, AVirtualClockGivesEachStepItsMilliseconds) {
    VirtualHand hand(hand_, *channel_, 60);
    hand.begin(sand_);
    ASSERT_EQ(times_, std::vector<double>{0}) << "the hand is read once while it rests";
    std::vector<std::size_t> ticks;
    for (int step = 0; step < 6; ++step) {
        const std::size_t before = times_.size();
        (void)nextStep(hand);
        ticks.push_back(times_.size() - before);
        hand.publish(sand_, false);
    }
    EXPECT_EQ(ticks, (std::vector<std::size_t>{16, 17, 17, 16, 17, 17}));
    for (std::size_t i = 1; i < times_.size(); ++i) {
        EXPECT_NEAR(times_[i], 0.001 * static_cast<double>(i), 1e-12);
    }
    hand.begin(sand_);
    EXPECT_NEAR(times_.back(), 0.1, 1e-12) << "the clock continues in the next link";
    EXPECT_FALSE(hand.onHostClock());
}

TEST_F(DeviceHandTest, AVirtualHandFeelsTheSandThatWasPublishedLast) {
    VirtualHand hand(hand_, *channel_, 60);
    hand.begin(sand_);
    (void)nextStep(hand);
    EXPECT_EQ(hand_.lastTick().surfaceStep, 0U);
    sand::Replica later(scene_);
    sand::Step step;
    step.number = 1;
    later.apply(step);
    hand.publish(later, false);
    (void)nextStep(hand);
    EXPECT_EQ(hand_.lastTick().surfaceStep, 1U);
    EXPECT_EQ(hand_.lastTick().surfaceAge, 0) << "never stale";
}

TEST_F(DeviceHandTest, AChannelCarriesSamplesOneWayAndSandTheOther) {
    ChannelHand hand(hand_, *channel_, 60);
    const std::uint32_t before = channel_->sitting;
    hand.begin(sand_);
    EXPECT_TRUE(channel_->moving);
    EXPECT_EQ(channel_->sitting, before + 1);
    EXPECT_EQ(channel_->surface.latest().step, 0U);
    EXPECT_FALSE(channel_->surface.latest().patch.empty());
    (void)channel_->samples.push({1, {1, 2, 3}, true});
    hand.drain();
    EXPECT_EQ(nextStep(hand).path, (std::vector<sand::ProbePoint>{{1, 2, 3}}));
    hand.end();
    EXPECT_FALSE(channel_->moving);
    (void)channel_->samples.push({2, {4, 5, 6}, true});
    hand.drain();
    hand.begin(sand_);
    (void)channel_->samples.push({3, {7, 8, 9}, true});
    hand.drain();
    EXPECT_EQ(nextStep(hand).path, (std::vector<sand::ProbePoint>{{7, 8, 9}})) << "dropped samples do not come later";
    EXPECT_EQ(hand.dropped(), 0U) << "samples of a hand that is not present do not count";
    channel_->overflow = 3;
    EXPECT_EQ(hand.dropped(), 3U);
    EXPECT_TRUE(times_.empty()) << "only the force thread reads the hand";
}

TEST_F(DeviceHandTest, TheGuardsSeeHowLongAMovementWaits) {
    ChannelHand hand(hand_, *channel_, 60, [] { return 1000; });
    hand.begin(sand_);
    const auto stepNs = [&] {
        hand.publish(sand_, false);
        return channel_->surface.latest().stepNs;
    };
    EXPECT_EQ(stepNs(), 1000);
    for (const std::int64_t readNs : {300, 400, 500}) {
        (void)channel_->samples.push({readNs, {1, 2, 3}, readNs > 300});
    }
    hand.drain();
    EXPECT_EQ(stepNs(), 400) << "the oldest engaged sample";
    (void)nextStep(hand);
    (void)nextStep(hand);
    EXPECT_EQ(stepNs(), 1000);
}

TEST_F(DeviceHandTest, AForceThreadThatHangsLiftsTheToolUntilItGoesOn) {
    std::int64_t now = 1000;
    ChannelHand hand(hand_, *channel_, 60, [&now] { return now; });
    hand.begin(sand_);
    (void)channel_->samples.push({1000, {1, 2, 3}, true});
    hand.drain();
    EXPECT_TRUE(nextStep(hand).engaged);
    now += ChannelHand::kPatienceNs;
    hand.drain();
    EXPECT_TRUE(nextStep(hand).engaged) << "a busy machine";
    ++now;
    hand.drain();
    EXPECT_FALSE(nextStep(hand).engaged);
    EXPECT_FALSE(nextStep(hand).engaged);
    EXPECT_EQ(hand.dropped(), 0U);
    (void)channel_->samples.push({now += 1000, {4, 5, 6}, true});
    hand.drain();
    const sand::Step back = nextStep(hand);
    EXPECT_TRUE(back.engaged);
    EXPECT_EQ(back.path, (std::vector<sand::ProbePoint>{{4, 5, 6}}));
}

TEST(HandTicks, CountTicksWithAForceAndTicksOfAFault) {
    const scene::Scene scene = samples::flatScene(60, 60);
    test::FakeArm::State arm;
    HapticTick hand(scene, std::make_unique<MappedDevice>(std::make_unique<test::FakeArm>(arm), HandSettings{}, scene),
                    HandSettings::Datum::level);
    std::int64_t now = 0;  // [ns]
    FeltSand felt;
    takeSurface(sand::Replica(scene), hand.probe(), felt);
    const auto ticks = [&](int count) {
        for (; count > 0; --count) {
            felt.timeNs = felt.stepNs = now += 1'000'000;
            (void)hand.tick(static_cast<double>(now) * 1e-9, now, felt);
        }
    };
    arm.reading.place.z = -0.09;  // [m], in the sand
    ticks(100);
    const std::uint64_t pushed = hand.handTicks().felt();
    EXPECT_GT(pushed, 90U) << "the ramp begins with 0";
    EXPECT_GT(norm(arm.pushed), 0);
    EXPECT_EQ(hand.handTicks().faulted(), 0U);
    arm.reading.present = false;
    ticks(20);
    EXPECT_EQ(norm(arm.pushed), 0);
    EXPECT_EQ(hand.handTicks().all(), 120U);
    EXPECT_EQ(hand.handTicks().felt(), pushed + 9) << "the force fades in the first ten";
    EXPECT_EQ(hand.handTicks().faulted(), 10U);
    hand.rest(1);
    EXPECT_EQ(hand.handTicks().all(), 120U) << "no master is linked";
}

}  // namespace
