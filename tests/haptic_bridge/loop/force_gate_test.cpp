// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/force_gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptic_bridge/hand/guard_counts.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Vec3;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kGateTick = 1e-3;  // [s]

/// A gate of 8 N with a slew limit of 0.1 N per tick, unless given. The ramp of its start is over.
struct OpenGate {
    ForceGate gate;
    double time = 0;          // [s], of the last tick
    std::uint32_t acted = 0;  // at the last tick

    explicit OpenGate(double slew = 0.1) : gate(limitsOf(slew)) { gate.restart(-2); }

    static ForceLimits limitsOf(double slew) {
        ForceLimits limits;
        limits.maxForce = 8;
        limits.slew = slew;
        return limits;
    }
    /// Passes `force`, one tick later.
    Vec3 pass(Vec3 force, bool contact = false, bool edited = false) {
        return passAt(time + kGateTick, force, contact, edited);
    }
    Vec3 passAt(double at, Vec3 force, bool contact = false, bool edited = false) {
        time = at;
        acted = 0;
        return gate.pass({at, force, norm(force), contact, edited}, acted);
    }
    /// Presses until the gate passes `size` [N].
    void press(double size) {
        for (int tick = 0; tick < 400; ++tick) {
            (void)pass({0, 0, size}, true);
        }
        ASSERT_NEAR(pass({0, 0, size}, true).z, size, 1e-12);
        ASSERT_EQ(acted, 0U);
    }
};

TEST(ForceGate, PassesAForceWithinAllBoundsAsItIs) {
    OpenGate gate;
    const Vec3 passed = gate.pass({0.05, -0.06, 0.04}, true);
    EXPECT_EQ(passed.x, 0.05);
    EXPECT_EQ(passed.y, -0.06);
    EXPECT_EQ(passed.z, 0.04);
    EXPECT_EQ(gate.acted, 0U);
}

// 10 N along (0.6, 0, 0.8) become the device's 8 N.
TEST(ForceGate, ShortensAForceToTheDevicesWithoutTurningIt) {
    OpenGate gate(100);
    const Vec3 passed = gate.pass({6, 0, 8});
    EXPECT_NEAR(passed.x, 4.8, 1e-12);
    EXPECT_NEAR(passed.z, 6.4, 1e-12);
    EXPECT_EQ(gate.acted, bit(Guard::clamp));
    (void)gate.pass({0, 0, 8});
    EXPECT_EQ(gate.acted, 0U);
}

// One and a half slew limits are 0.15 N per tick.
TEST(ForceGate, LetsAForceGrowAndTurnByOneAndAHalfSlewLimits) {
    OpenGate gate;
    for (int tick = 1; tick <= 6; ++tick) {
        EXPECT_NEAR(gate.pass({0, 0, 1}).z, 0.15 * tick, 1e-12);
        EXPECT_EQ(gate.acted, bit(Guard::gate));
    }
    EXPECT_NEAR(gate.pass({0, 0, 1}).z, 1, 1e-12);
    EXPECT_EQ(gate.acted, 0U);
    const Vec3 turned = gate.pass({0.2, 0, 1});
    EXPECT_NEAR(turned.x, 0.15, 1e-12);
    EXPECT_NEAR(turned.z, 1, 1e-12);
    EXPECT_EQ(gate.acted, bit(Guard::gate));
    EXPECT_NEAR(gate.pass({0, 0, -1}).z, -0.15, 2e-3) << "a force that reverses begins at 0";
}

TEST(ForceGate, LetsAForceFallAtOnce) {
    OpenGate gate;
    gate.press(5);
    EXPECT_EQ(gate.pass({0, 0, 1}, true).z, 1);
    EXPECT_EQ(gate.acted, 0U);
    EXPECT_EQ(norm(gate.pass({}, false)), 0);
    EXPECT_EQ(gate.acted, 0U);
}

TEST(ForceGate, GrowsForTwoSecondsAfterARestart) {
    OpenGate gate(100);
    gate.gate.restart(10);
    for (const double since : {0.0, 0.5, 1.0, 1.999}) {
        EXPECT_NEAR(gate.passAt(10 + since, {0, 0, 4}).z, 2 * since, 1e-9) << since;
        EXPECT_EQ(gate.acted, bit(Guard::ramp)) << since;
    }
    EXPECT_EQ(gate.passAt(12, {0, 0, 4}).z, 4);
    EXPECT_EQ(gate.acted, 0U);
    gate.gate.restart(12);
    EXPECT_EQ(norm(gate.passAt(12, {0, 0, 4})), 0);
    EXPECT_EQ(norm(gate.passAt(11, {0, 0, 4})), 0) << "a clock that runs backwards";
    EXPECT_EQ(norm(gate.passAt(13, {})), 0);
    EXPECT_EQ(gate.acted, 0U) << "no force, and no guard";
}

// After one of two seconds a device of 8 N gets at most 4 N, whatever is asked for.
TEST(ForceGate, ARampIsNotShorterForAForceBeyondTheDevices) {
    OpenGate gate(100);
    gate.gate.restart(10);
    EXPECT_NEAR(gate.passAt(11, {0, 0, 800}).z, 4, 1e-12);
    EXPECT_EQ(gate.acted, bit(Guard::ramp) | bit(Guard::clamp));
}

TEST(ForceGate, PassesNothingAtANumberThatIsNotFiniteAndRampsAfterIt) {
    for (const double bad : {kNaN, kUnbounded, -kUnbounded}) {
        for (const ForceGate::Wanted& wanted :
             {ForceGate::Wanted{1, {bad, 0, 1}, 1}, ForceGate::Wanted{1, {0, bad, 1}, 1},
              ForceGate::Wanted{1, {0, 0, bad}, 1}, ForceGate::Wanted{1, {0, 0, 1}, bad},
              ForceGate::Wanted{bad, {0, 0, 1}, 1}, ForceGate::Wanted{1, {1e200, 0, 0}, 1}}) {
            OpenGate gate;
            gate.press(4);
            std::uint32_t acted = 0;
            EXPECT_EQ(norm(gate.gate.pass(wanted, acted)), 0);
            EXPECT_EQ(acted, bit(Guard::notANumber));
            // A fault without a time begins its ramp at the next tick.
            const double from = std::isfinite(wanted.time) ? 1 : 1.001;
            for (int tick = 1; tick <= 1001; ++tick) {
                (void)gate.passAt(1 + tick * kGateTick, {0, 0, 4});
                ASSERT_EQ(gate.acted & bit(Guard::ramp), bit(Guard::ramp));
            }
            EXPECT_NEAR(gate.pass({0, 0, 4}).z, 4 * (2.002 - from) / 2, 1e-9);
        }
    }
}

TEST(ForceGate, AContactThatBeginsAtTheSurfaceHasNoRamp) {
    OpenGate gate;
    EXPECT_EQ(gate.pass({0, 0, 0.05}, true).z, 0.05);
    EXPECT_EQ(gate.pass({0, 0, 0.15}, true).z, 0.15);
    EXPECT_EQ(gate.acted, 0U);
}

TEST(ForceGate, OnlyAnExcessOfMoreThanOneSlewLimitGrows) {
    OpenGate at, above;
    EXPECT_EQ(at.pass({0, 0, 0.1}, true).z, 0.1);
    EXPECT_EQ(at.acted, 0U);
    EXPECT_EQ(norm(above.pass({0, 0, 0.101}, true)), 0);
    EXPECT_EQ(above.acted, bit(Guard::contact));
    EXPECT_NEAR(above.pass({0, 0, 0.101}, true).z, 0.101 / 200, 1e-12);
}

// 4 N grow over 200 ticks, by 0.02 N per tick.
TEST(ForceGate, TheExcessOfAContactGrowsOverAFifthOfASecond) {
    OpenGate gate;
    int ticks = 0;
    for (int tick = 0; tick < 250; ++tick) {
        EXPECT_NEAR(gate.pass({0, 0, 4}, true).z, 0.02 * std::min(tick, 200), 1e-9) << tick;
        ticks += gate.acted == bit(Guard::contact) ? 1 : 0;
        EXPECT_EQ(gate.acted & ~bit(Guard::contact), 0U) << tick;
    }
    EXPECT_NEAR(ticks, 200, 1);
}

TEST(ForceGate, ADeeperTouchMeanwhileStaysInTheGrowth) {
    OpenGate gate;
    (void)gate.pass({0, 0, 2}, true);
    for (int tick = 0; tick < 99; ++tick) {
        (void)gate.pass({0, 0, 2}, true);
    }
    EXPECT_NEAR(gate.pass({0, 0, 3}, true).z, 1.15 - 0.01, 1e-9) << "0.99 N, and one and a half slew limits";
    for (int tick = 0; tick < 49; ++tick) {
        (void)gate.pass({0, 0, 3}, true);
    }
    EXPECT_NEAR(gate.pass({0, 0, 3}, true).z, 3 * 0.75, 1e-9) << "150 of 200 ticks";
}

TEST(ForceGate, TheGrowthEndsWithItsContact) {
    OpenGate gate;
    for (int tick = 0; tick < 50; ++tick) {
        (void)gate.pass({0, 0, 4}, true);
    }
    EXPECT_EQ(gate.acted, bit(Guard::contact));
    EXPECT_EQ(norm(gate.pass({}, false)), 0);
    EXPECT_EQ(gate.pass({0, 0, 0.05}, true).z, 0.05) << "the next contact begins at the surface";
    EXPECT_NEAR(gate.pass({0, 0, 4}, true).z, 0.2, 1e-12) << "only the gate's slew is left";
    EXPECT_EQ(gate.acted, bit(Guard::gate));
    (void)gate.pass({}, false);
    EXPECT_EQ(norm(gate.pass({0, 0, 4}, true)), 0) << "the next contact in the deep grows again";
}

// From 2 N to 6 N over 200 ticks, by 0.02 N per tick.
TEST(ForceGate, TheExcessOfAnEditGrowsFromTheLastForce) {
    OpenGate gate;
    gate.press(2);
    for (int tick = 0; tick < 200; ++tick) {
        EXPECT_NEAR(gate.pass({0, 0, 6}, true, tick == 0).z, 2 + 0.02 * tick, 1e-9) << tick;
        EXPECT_EQ(gate.acted, bit(Guard::contact)) << tick;
    }
    EXPECT_NEAR(gate.pass({0, 0, 6}, true).z, 6, 1e-9);
}

TEST(ForceGate, AnEditWithoutExcessIsFeltAtOnce) {
    OpenGate gate;
    gate.press(2);
    EXPECT_EQ(gate.pass({0, 0, 2.1}, true, true).z, 2.1) << "one slew limit";
    EXPECT_EQ(gate.pass({0, 0, 0.5}, true, true).z, 0.5) << "less sand";
    EXPECT_EQ(gate.acted, 0U);
    EXPECT_NEAR(gate.pass({0, 0, 6}, true).z, 0.65, 1e-12) << "without an edit only the gate's slew is left";
    EXPECT_EQ(gate.acted, bit(Guard::gate));
}

// A second after a start half of 4 N are allowed. A contact that begins then has grown by half 0.1 s later, when the
// ramp allows 2.2 N.
TEST(ForceGate, AContactWithinARampGrowsToWhatTheRampAllows) {
    OpenGate gate;
    gate.gate.restart(10);
    (void)gate.passAt(10.999, {});
    for (int tick = 0; tick < 100; ++tick) {
        (void)gate.passAt(11 + tick * kGateTick, {0, 0, 4}, true);
    }
    EXPECT_NEAR(gate.passAt(11.1, {0, 0, 4}, true).z, 1.1, 1e-9);
    EXPECT_EQ(gate.acted, bit(Guard::ramp) | bit(Guard::contact));
}

}  // namespace
