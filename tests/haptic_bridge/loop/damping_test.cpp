// SPDX-License-Identifier: Apache-2.0
// The damping of the observer within the guards: it changes in small steps, and ends with a fault.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"
#include "tests/support/hand/arm_loop.hpp"
#include "tests/support/hand/arm_on_sand.hpp"

namespace {

using namespace haptic_bridge;
using test::kTick;

ForceLimits pumpedLimits() { return ForceLimits::of(touchPreset(), test::kScale, {500, 50, 5}, 0.67); }

constexpr double kPumped = 2;  // [N], the device's part of the law's push

/// Returns tick `tick` of a hand that goes 2 cm up and down four times a second, against a push that never changes. On
/// each way up the push gives the hand more energy than a spring could have kept, so that the observer damps it.
Guards::Reading pumping(int tick) {
    constexpr double kAmplitude = 0.01, kTurn = 2 * std::numbers::pi * 4;  // [m], [1/s]
    Guards::Reading reading;
    reading.time = tick * kTick;
    reading.engaged = true;
    reading.place = {0, 0, kAmplitude * std::sin(kTurn * reading.time)};
    reading.velocity = {0, 0, kAmplitude * kTurn * std::cos(kTurn * reading.time)};
    reading.felt = {{0, 0, kPumped / pumpedLimits().gain}, {0, 0, 1}, 50, 500};
    return reading;
}
constexpr int kRamped = 2500;  // ticks after which the ramp of a start is over

TEST(Guards, DampAHandInSmallSteps) {
    const ForceLimits limits = pumpedLimits();
    Guards guards(limits);
    double before = 0, least = kPumped, most = kPumped;
    for (int tick = 0; tick < kRamped + 2000; ++tick) {
        const double sent = guards.tick(pumping(tick)).sent.z;
        if (tick > kRamped) {
            // The law's force is the same at all ticks, so that only the damping changes what is sent.
            ASSERT_LE(std::abs(sent - before), limits.slew / 2 * (1 + 1e-9)) << "tick " << tick;
            least = std::min(least, sent);
            most = std::max(most, sent);
        }
        before = sent;
    }
    EXPECT_LT(least, kPumped - 3 * limits.slew) << "on the way up; the damping needs many steps";
    EXPECT_GT(most, kPumped + 3 * limits.slew) << "on the way down";
}

/// Runs a hand until the observer damps it, then makes a reading bad. From there on the guards must be as new ones.
template <class Hurt>
void expectNewAfter(const std::string& fault, const Hurt& hurt) {
    Guards guards(pumpedLimits());
    int tick = 0;
    // Until damping acts that takes several ticks to fall to 0.
    for (double sent = kPumped; tick < kRamped || sent > kPumped - 4 * pumpedLimits().slew; ++tick) {
        ASSERT_LT(tick, kRamped + 2000) << fault;
        sent = guards.tick(pumping(tick)).sent.z;
    }
    Guards::Reading bad = pumping(tick);
    hurt(bad);
    EXPECT_EQ(norm(guards.tick(bad).sent), 0) << fault;
    Guards fresh(pumpedLimits());
    bad.present = false;  // a fault of new guards, too
    (void)fresh.tick(bad);
    const double later = bad.time - pumping(tick).time;
    for (const int last = tick + 3000; ++tick < last;) {
        Guards::Reading reading = pumping(tick);
        reading.time += later;
        const Guards::Forces old = guards.tick(reading), expected = fresh.tick(reading);
        ASSERT_EQ(norm(old.sent - expected.sent), 0) << fault << ", tick " << tick;
        ASSERT_EQ(old.acted, expected.acted) << fault << ", tick " << tick;
    }
}

TEST(Guards, AreNewAfterEveryKindOfFault) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    expectNewAfter("not a number", [&](Guards::Reading& r) { r.felt.push.x = none; });
    expectNewAfter("stale", [](Guards::Reading& r) { r.surfaceAge = 0.0501; });
    expectNewAfter("missed", [](Guards::Reading& r) { r.time += 0.0101; });
    expectNewAfter("lost", [](Guards::Reading& r) { r.present = false; });
    expectNewAfter("jumped", [](Guards::Reading& r) { r.place.x = 1; });
}

}  // namespace
