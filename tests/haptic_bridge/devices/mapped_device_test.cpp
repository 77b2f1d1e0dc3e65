// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/mapped_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/input_error.hpp"
#include "scene/model/scene.hpp"
#include "tests/haptic_bridge/devices/fake_arm.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Vec3;
using test::FakeArm;

constexpr double kArmTick = 1e-3;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// An arm of 0.1 m reach over a field of 40 x 30 cells, ticked at 1 kHz.
class Mapped : public testing::Test {
protected:
    void map(const std::vector<std::string>& options) {
        device_ =
            std::make_unique<MappedDevice>(std::make_unique<FakeArm>(state_), HandSettings::parse(options), scene_);
    }
    Pose at(Vec3 place) {
        state_.reading.place = place;
        return device_->read(time_ += kArmTick);
    }
    /// Returns the force that the arm is pushed with.
    Vec3 feel(Vec3 force) {
        device_->sendForce(force);
        return state_.pushed;
    }
    /// Runs ticks until the ramp at the start is over.
    void rest() {
        for (int i = 0; i < 600; ++i) {
            (void)at(state_.reading.place);
        }
    }
    void expectEqual(Vec3 a, Vec3 b) {
        EXPECT_DOUBLE_EQ(a.x, b.x);
        EXPECT_DOUBLE_EQ(a.y, b.y);
        EXPECT_DOUBLE_EQ(a.z, b.z);
    }
    const scene::Scene scene_ = samples::flatScene(40, 30);
    const double half_ = 15 * scene_.terrain.cellSize();  // [scene unit]
    FakeArm::State state_;
    std::unique_ptr<MappedDevice> device_;
    double time_ = 0;
};

TEST_F(Mapped, FitsTheReachIntoTheField) {
    map({});
    const Pose pose = at({0.1, 0, 0});
    EXPECT_DOUBLE_EQ(pose.x, 0.8);
    EXPECT_DOUBLE_EQ(pose.y, 0);
    EXPECT_DOUBLE_EQ(pose.z, 1) << "the tool touches";
    EXPECT_TRUE(pose.engaged);
    EXPECT_DOUBLE_EQ(device_->scale(), 0.8 * half_ / 0.1);
}

TEST_F(Mapped, TurnsPlacesAndTurnsForcesBack) {
    // The device's y axis points up, and its z axis points towards the user.
    map({"axes=x,-z,y", "scale=2"});
    rest();
    const Pose pose = at({0.01, 0.02, 0.03});
    EXPECT_DOUBLE_EQ(pose.x, 0.01 * 2 / half_);
    EXPECT_DOUBLE_EQ(pose.y, -0.03 * 2 / half_);
    EXPECT_DOUBLE_EQ(pose.z, 1 + 0.02 * 2 / scene_.toolRadius());
    expectEqual(feel({1, 2, 3}), {1, 3, -2});
    EXPECT_DOUBLE_EQ(device_->scale(), 2) << "a force stays the same in newtons; only stiffness scales";
}

// A spring in the scene is also a spring at the hand: pushed round any closed loop, it returns the energy that it took.
TEST_F(Mapped, NeverPutsEnergyIntoAClosedPath) {
    for (const std::string vertical : {"vertical=0.25", "vertical=1", "vertical=3"}) {
        map({"scale=2", vertical, "axes=-y,z,x"});
        rest();
        double work = 0, moved = 0;
        Vec3 before{0.01, 0, 0}, pushed;
        constexpr int kSteps = 20000;
        for (int i = 0; i <= kSteps; ++i) {
            const double turn = 2 * std::numbers::pi * i / kSteps;
            const Vec3 place{0.01 * std::cos(turn), 0.008 * std::sin(turn), 0.006 * std::sin(turn + 0.7)};
            const Pose pose = at(place);
            // The gradient of an elliptic bowl, so that height and sides share their energy.
            const double x = pose.x * half_, y = pose.y * half_, z = pose.z * scene_.toolRadius();
            const Vec3 force{-30 * x - 20 * z, -10 * y, -50 * z - 20 * x};
            const Vec3 now = feel(force);
            if (i > 0) {
                work += 0.5 * dot(pushed + now, place - before);
                moved += std::abs(0.5 * dot(pushed + now, place - before));
            }
            before = place;
            pushed = now;
        }
        EXPECT_GT(moved, 1e-3) << "the path is not level";
        EXPECT_LT(std::abs(work), 1e-9 * moved) << vertical;
    }
}

TEST_F(Mapped, AForceIsNeverLongerAtTheHandThanItWasSent) {
    for (const std::string vertical : {"vertical=0.25", "vertical=4"}) {
        map({vertical});
        rest();
        EXPECT_LE(norm(feel({1, -2, 2})), 3) << vertical;
        EXPECT_DOUBLE_EQ(norm(feel(vertical == "vertical=4" ? Vec3{0, 0, 2} : Vec3{0, 2, 0})), 2);
    }
}

TEST_F(Mapped, TheClutchHoldsTheToolWhileTheHandMoves) {
    map({"scale=2"});
    rest();
    const Pose before = at({0.03, 0, 0});
    expectEqual(feel({0, 0, 1}), {0, 0, 1});
    state_.reading.second = true;
    for (int i = 0; i <= 60; ++i) {
        const Pose held = at({0.03 - 0.001 * i, 0, 0});
        EXPECT_DOUBLE_EQ(held.x, before.x);
        EXPECT_TRUE(held.engaged);
        EXPECT_TRUE(device_->reading().second) << "the guards must notice";
    }
    state_.reading.second = false;
    EXPECT_NEAR(at({-0.02, 0, 0}).x, before.x + 0.01 * 2 / half_, 1e-12) << "the tool continues from there";
}

TEST_F(Mapped, TheWorkspaceDriftsToTheHandWhileNothingIsFelt) {
    map({"scale=2", "drift=0.1"});
    rest();
    (void)at({0.05, 0, 0});
    const double before = at({0.05, 0, 0}).x;
    for (int i = 0; i < 100; ++i) {
        (void)at({0.05 + (i % 2 == 0 ? 0.002 : 0), 0, 0});
    }
    const double drifted = at({0.05, 0, 0}).x;
    EXPECT_GT(drifted, before) << "the same place of the hand lies farther out";
    (void)feel({0, 0, 1});
    for (int i = 0; i < 100; ++i) {
        (void)at({0.05 + (i % 2 == 0 ? 0.002 : 0), 0, 0});
        (void)feel({0, 0, 1});
    }
    EXPECT_DOUBLE_EQ(at({0.05, 0, 0}).x, drifted) << "a force is felt: a moving origin would do work";
}

TEST_F(Mapped, ABadReadingLiftsTheHandAndCountsAsAbsent) {
    const std::array<std::pair<Trouble, ArmReading>, 3> bad{{
        {Trouble::absent, {{}, false, false, false}},
        {Trouble::noNumber, {{0, kNoNumber, 0}, false, false, true}},
        {Trouble::jump, {{1, 0, 0}, false, false, true}},
    }};
    for (const auto& [trouble, reading] : bad) {
        state_ = {};
        map({});
        rest();
        const Pose before = at({0.01, 0, 0});
        expectEqual(feel({0, 0, 2}), {0, 0, 2});
        state_.reading = reading;
        const int late = trouble == Trouble::absent ? MappedDevice::kMayBeLate : 0;
        for (int lost = 0; lost < late; ++lost) {
            (void)device_->read(time_ += kArmTick);
        }
        EXPECT_EQ(device_->troubles()->of(trouble), 0U) << "an arm may only be late";
        const Pose during = device_->read(time_ += kArmTick);
        EXPECT_EQ(device_->answers(), trouble != Trouble::absent) << "a reading that is not plausible is a fault";
        EXPECT_FALSE(during.engaged);
        EXPECT_DOUBLE_EQ(during.x, before.x) << "the tool stays where it was";
        EXPECT_FALSE(device_->reading().present) << "the guards must notice";
        EXPECT_DOUBLE_EQ(device_->reading().place.x, 0.01) << "and never see an invalid place";
        EXPECT_EQ(device_->troubles()->of(trouble), 1U);
        // The tool comes back: after a jump, at the arm's new place.
        state_.reading = {{trouble == Trouble::jump ? 1 : 0.01, 0, 0}, false, false, true};
        EXPECT_TRUE(device_->read(time_ += kArmTick).engaged);
        EXPECT_TRUE(device_->reading().present);
        EXPECT_TRUE(device_->answers());
    }
}

TEST_F(Mapped, ReadingsThatRunBackwardsAreLeftOut) {
    map({});
    rest();
    const Pose before = at({0.01, 0, 0});
    state_.reading.place = {0.02, 0, 0};
    const Pose during = device_->read(time_ - 0.5);
    EXPECT_FALSE(during.engaged);
    EXPECT_DOUBLE_EQ(during.x, before.x);
    EXPECT_FALSE(device_->reading().present);
    EXPECT_EQ(device_->troubles()->of(Trouble::backwards), 1U);
}

TEST_F(Mapped, RefusesAHeightThatFollowsTheSurface) {
    EXPECT_THROW(map({"datum=surface"}), base::InputError);
    EXPECT_THROW(map({"drift=2"}), base::InputError);
}

TEST(Troubles, AreToldOnceNotAThousandTimesASecond) {
    TroubleCounts counts;
    TroubleReporter reporter("device Touch");
    EXPECT_TRUE(reporter.lines(counts, 0).empty());
    int told = 0;
    std::string first;
    for (int tick = 0; tick < 25'000; ++tick) {
        counts.count(Trouble::noNumber);
        for (const std::string& line : reporter.lines(counts, tick * kArmTick)) {
            first = first.empty() ? line : first;
            ++told;
        }
    }
    EXPECT_EQ(told, 3) << "one line every ten seconds";
    EXPECT_EQ(
        first,
        "device Touch sends values that are not finite, 1 times so far; the tool is lifted and the hand feels nothing");
}

TEST(Troubles, AnAbsentDeviceIsToldWhenItGoesAndWhenItIsBack) {
    TroubleCounts counts;
    TroubleReporter reporter("device Touch");
    std::vector<std::string> told;
    const auto run = [&](int from, int to, bool away) {  // [tick]
        for (int tick = from; tick < to; ++tick) {
            if (away) {
                counts.count(Trouble::absent);
            }
            for (const std::string& line : reporter.lines(counts, tick * kArmTick)) {
                told.push_back(line);
            }
        }
    };
    run(0, 5'000, false);
    run(5'000, 30'000, true);
    run(30'000, 40'000, false);
    run(40'000, 41'000, true);
    ASSERT_EQ(told.size(), 3U);
    EXPECT_EQ(told[0], "device Touch does not answer; the tool is lifted and the hand feels nothing until it answers");
    EXPECT_EQ(told[1], "device Touch answers again");
    EXPECT_EQ(told[2], told[0]);
}

}  // namespace
