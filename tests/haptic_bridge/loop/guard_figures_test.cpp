// SPDX-License-Identifier: Apache-2.0
// Compares the guards with figures that were derived on paper from docs/forces.md, with T = 1 ms.
#include <gtest/gtest.h>

#include <algorithm>

#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"
#include "haptic_bridge/loop/guards/limited_law.hpp"
#include "haptic_bridge/loop/guards/velocity_window.hpp"
#include "tests/support/hand/arm_loop.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Response;
using sand::force::Vec3;
using test::kTick;

/// The law of Dorjgotov et al. 2007 at a depth of one radius on its field, 2 scene units over 0.16 m: 500 N and 50
/// N·frame per scene unit.
constexpr double kFieldScale = 12.5;  // [scene unit/m]
constexpr LawAtRadius kFieldLaw{500, 50, 5};

ForceLimits figuresOf(const ArmPhysics& arm) { return ForceLimits::of(arm, kFieldScale, kFieldLaw, 0.67); }

// K = b / (T/2 + t_d) / 2 if the maker allows more; B = m / (T/2 + t_d + 7.5 T); the slew K · 2 m/s · T. The presets
// have a delay of 1 ms: 1.5 ms in K and 9 ms in B.
TEST(GuardFigures, AreThoseOfEachArm) {
    struct Row {
        const char* arm;
        double stiffness, damping, slew;  // [N/m], [N·s/m], [N/tick]
    };
    for (const auto& [name, stiffness, damping, slew] :
         {Row{"touch", 116.6667, 5, 0.2333333}, Row{"falcon", 500, 14.44444, 1},
          Row{"omega.3", 833.3333, 22.22222, 1.666667}, Row{"delta.3", 833.3333, 27.77778, 1.666667}}) {
        SCOPED_TRACE(name);
        const ForceLimits limits = figuresOf(*armPreset(name));
        EXPECT_NEAR(limits.stiffness, stiffness, 1e-4);
        EXPECT_NEAR(limits.damping, damping, 1e-5);
        EXPECT_NEAR(limits.slew, slew, 1e-6);
        // 500 N per unit at 12.5 units per metre are 6250 N/m.
        EXPECT_NEAR(limits.gain, stiffness / 6250, 1e-7);
        EXPECT_NEAR(limits.lawStiffness, stiffness, 1e-4);
    }
    ArmPhysics touch = touchPreset();
    touch.delayTicks = 0;  // 0.35 / 0.5 ms / 2 is 350 N/m, but half of what its maker allows is 200; 0.045 / 8 ms
    EXPECT_NEAR(figuresOf(touch).stiffness, 200, 1e-9);
    EXPECT_NEAR(figuresOf(touch).damping, 5.625, 1e-9);
    EXPECT_NEAR(figuresOf(touch).slew, 0.4, 1e-12);
    touch.delayTicks = 3;  // 0.35 / 3.5 ms / 2; 0.045 / 11 ms
    EXPECT_NEAR(figuresOf(touch).stiffness, 50, 1e-9);
    EXPECT_NEAR(figuresOf(touch).damping, 4.090909, 1e-6);
}

// The slew follows the law that the device gets, not the K that it could bear. 5 N per unit are 62.5 N/m.
TEST(GuardFigures, OfASoftLawAreItsOwn) {
    const ForceLimits limits = ForceLimits::of(touchPreset(), kFieldScale, {5, 0.5, 0.05}, 0.67);
    EXPECT_EQ(limits.gain, 1);
    EXPECT_NEAR(limits.lawStiffness, 62.5, 1e-9);
    EXPECT_NEAR(limits.slew, 0.125, 1e-9);
}

/// A Touch of m = 0.045 kg without limits. Each test sets its own limits.
ForceLimits freeTouch() {
    ForceLimits limits = figuresOf(touchPreset());
    limits.gain = 1;
    limits.stiffness = limits.damping = limits.internalFriction = limits.slew = limits.maxForce = 1e12;
    limits.resolution = 0;
    return limits;
}
/// Returns the drag [N·frame/scene unit] for a damping in [N·s/m].
double dragOf(double viscous) { return viscous * 60 / kFieldScale; }

// B becomes B / (1 + 2 B T/m): T/m is 1/45 m/(N·s).
TEST(GuardFigures, FrictionGrowsSoftly) {
    struct Row {
        double asked, soft;  // [N·s/m]
    };
    for (const auto& [asked, soft] :
         {Row{0.45, 0.4411765}, Row{5, 4.090909}, Row{22.5, 11.25}, Row{45, 15}, Row{627, 21.72055}, Row{1e9, 22.5}}) {
        std::uint32_t acted = 0;
        const Response felt{{0, 0, 1}, {0, 0, 1}, dragOf(asked), 0};
        const Vec3 force = limitedForce(felt, {0.02, -0.01, 0.3}, freeTouch(), acted);
        EXPECT_NEAR(force.x, -0.02 * soft, 1e-6) << asked;
        EXPECT_NEAR(force.y, 0.01 * soft, 1e-6) << asked;
        EXPECT_NEAR(force.z, 1, 1e-12) << "no friction along the normal";
        // 0.45 loses 2 %. Only a loss of more than 3 % sets the bit.
        EXPECT_EQ(acted, asked < 1 ? 0 : bit(Guard::damping)) << asked;
    }
}

TEST(GuardFigures, FrictionIsAtMostWhatTheArmBearsAndTheSandHolds) {
    ForceLimits limits = freeTouch();
    limits.damping = 5;
    std::uint32_t acted = 0;
    // 45 N·s/m, softened to 15, exceed the limit of 5. A speed of 0.02 m/s therefore gives 0.1 N.
    const Response felt{{0, 0, 1}, {0, 0, 1}, dragOf(45), 0};
    EXPECT_NEAR(limitedForce(felt, {0.02, 0, 0}, limits, acted).x, -0.1, 1e-12);
    EXPECT_EQ(acted, bit(Guard::damping));
    // Pushed with 1 N, sand of µ = 0.04 holds 0.04 N, whatever the speed and its direction.
    limits.internalFriction = 0.04;
    acted = 0;
    const Vec3 force = limitedForce(felt, {0.012, 0.016, 0}, limits, acted);
    EXPECT_NEAR(force.x, -0.024, 1e-12);
    EXPECT_NEAR(force.y, -0.032, 1e-12);
    EXPECT_EQ(acted, bit(Guard::damping) | bit(Guard::friction));
}

// Friction acts along the surface. The normal is (-0.6, 0, 0.8), and the hand moves straight down by 0.02 m/s. The part
// along the surface is (0, 0, -0.02) + 0.016 (-0.6, 0, 0.8) = (-0.0096, 0, -0.0072). 4.090909 N·s/m act against it.
TEST(GuardFigures, FrictionRunsAlongASlope) {
    std::uint32_t acted = 0;
    const Response felt{{-0.6, 0, 0.8}, {-0.6, 0, 0.8}, dragOf(5), 0};
    const Vec3 force = limitedForce(felt, {0, 0, -0.02}, freeTouch(), acted);
    EXPECT_NEAR(force.x, -0.6 + 4.090909 * 0.0096, 1e-8);
    EXPECT_NEAR(force.y, 0, 1e-12);
    EXPECT_NEAR(force.z, 0.8 + 4.090909 * 0.0072, 1e-8);
}

/// Guards of a Touch over the field of Dorjgotov et al. 2007, whose hand has been in the air for longer than the ramp.
struct Warm {
    Guards guards{figuresOf(touchPreset())};
    Guards::Reading reading;

    explicit Warm(const ForceLimits& limits = figuresOf(touchPreset())) : guards(limits) {
        for (int tick = 0; tick < 2100; ++tick) {
            (void)next();
        }
    }
    Guards::Forces next(double span = kTick) {
        reading.time += span;
        return guards.tick(reading);
    }
};

// K · 2 m/s · T is 0.2333333 N per tick. A tool that touches the surface, with 1 N of the law, and goes deep at once is
// pushed as by a hand of 2 m/s. 1 N of the law is 116.6667/6250 N for the hand.
TEST(GuardFigures, AForceGrowsByTheSlewAndFallsAtOnce) {
    Warm hand;
    hand.reading.engaged = true;
    hand.reading.felt = {{0, 0, 1}, {0, 0, 1}, 0, 500};
    EXPECT_NEAR(hand.next().sent.z, 0.01866667, 1e-8) << "a contact that begins at the surface has no ramp";
    hand.reading.felt.push.z = 5000;
    for (int tick = 1; tick <= 14; ++tick) {
        const Guards::Forces forces = hand.next();
        EXPECT_NEAR(forces.sent.z, 0.01866667 + 0.2333333 * tick, 1e-5) << tick;
        EXPECT_EQ(forces.acted & bit(Guard::slew), bit(Guard::slew));
    }
    EXPECT_NEAR(hand.next().sent.z, 3.3, 1e-12) << "a Touch's greatest force";
    hand.reading.engaged = false;
    EXPECT_EQ(norm(hand.next().sent), 0);
}

// 5000 N of the law are more than a Touch's 3.3 N. A contact that begins with them grows by 3.3 N / 200 per tick.
TEST(GuardFigures, AContactThatBeginsInTheDeepGrowsOverAFifthOfASecond) {
    Warm hand;
    hand.reading.engaged = true;
    hand.reading.felt = {{0, 0, 5000}, {0, 0, 1}, 0, 500};
    for (int tick = 0; tick <= 200; ++tick) {
        const Guards::Forces forces = hand.next();
        EXPECT_NEAR(forces.sent.z, 0.0165 * tick, 1e-9) << tick;
        EXPECT_TRUE(tick == 200 || (forces.acted & bit(Guard::contact)) != 0) << tick;
    }
    EXPECT_EQ(hand.next().acted & bit(Guard::contact), 0U);
}

/// Returns whether a tip that moves by `way` [m] within `span` [s] sets the guard `jumped`.
bool silences(Vec3 way, double span) {
    ForceLimits limits = figuresOf(touchPreset());
    limits.resolution = 0;
    Warm hand(limits);
    hand.reading.place = way;
    return (hand.next(span).acted & bit(Guard::jumped)) != 0;
}

TEST(GuardFigures, NoTipIsFasterThanTwentyMetresASecond) {
    for (const double span : {1e-3, 5e-3}) {
        EXPECT_FALSE(silences({0, 0, -19 * span}, span)) << span;
        EXPECT_TRUE(silences({0, 0, -21 * span}, span)) << span;
        // The speed counts, and not the part along one axis: 11 m/s along each of three axes are 19.1 m/s, and 12 are
        // 20.8.
        EXPECT_FALSE(silences({11 * span, -11 * span, 11 * span}, span)) << span;
        EXPECT_TRUE(silences({12 * span, -12 * span, 12 * span}, span)) << span;
    }
    // In a tick that comes early the tip may move as far as in a whole tick.
    EXPECT_FALSE(silences({0.019, 0, 0}, 0.2e-3));
    EXPECT_TRUE(silences({0.021, 0, 0}, 0.2e-3));
}

TEST(GuardFigures, ASpeedIsNoneWithinTwoStepsOfTheEncoder) {
    ForceLimits limits = figuresOf(touchPreset());
    limits.resolution = 0.001;
    for (const double way : {0.0219, 0.0221}) {  // 20 mm, and twice 1 mm
        Warm hand(limits);
        hand.reading.place.y = way;
        EXPECT_EQ((hand.next().acted & bit(Guard::jumped)) != 0, way > 0.022) << way;
    }
}

/// An observer of an arm of 0.05 kg without delay, over sand without stiffness unless given.
PassivityObserver observerOf(double damping, double lawStiffness = 0, double resolution = 0, double maxForce = 2,
                             int delayTicks = 0) {
    ArmPhysics arm = test::textbookArm(damping, delayTicks);
    arm.resolution = resolution;
    arm.maxForce = maxForce;
    ForceLimits limits = ForceLimits::of(arm, 1, {}, 0);
    limits.lawStiffness = lawStiffness;
    return PassivityObserver(limits);
}

constexpr double kLeft = 0.998;  // share of a surplus that is left after a tick: 1 ms of the 500 ms of its memory

// Over 1 mm within a tick 1 N gives 1 mJ. Three quarters of b = 0.5 N·s/m take 0.75 · 0.5 · (1 mm)² / 1 ms = 0.375 mJ.
TEST(GuardFigures, TheArmIsTrustedWithThreeQuartersOfItsDamping) {
    PassivityObserver observer = observerOf(0.5);
    observer.observe({}, kTick);
    observer.sent({1, 0, 0});
    observer.observe({0.001, 0, 0}, kTick);
    EXPECT_NEAR(observer.returned(), 1e-3, 1e-15);
    EXPECT_NEAR(observer.surplus(), kLeft * 0.625e-3, 1e-12);
    // The surplus is taken back within a tick: 0.62375 mJ over (1 m/s)² · 1 ms.
    std::uint32_t acted = 0;
    EXPECT_NEAR(observer.control({1, 0, 0}, acted).x, -0.62375, 1e-9);
    EXPECT_EQ(acted, bit(Guard::passivity));
    // The damping is at most B = 0.05 / 8 ms = 6.25 N·s/m. At 0.1 m/s it would be 62.4 N·s/m.
    EXPECT_NEAR(observer.control({0, 0.1, 0}, acted).y, -0.625, 1e-12);
}

TEST(GuardFigures, ASurplusIsForgottenWithinHalfASecond) {
    PassivityObserver observer = observerOf(0);
    observer.observe({}, kTick);
    observer.sent({1, 0, 0});
    observer.observe({0.001, 0, 0}, kTick);
    const double before = observer.surplus();
    EXPECT_NEAR(before, kLeft * 1e-3, 1e-12);
    for (int tick = 0; tick < 500; ++tick) {
        observer.sent({});
        observer.observe({0.001, 0, 0}, kTick);
    }
    EXPECT_NEAR(observer.surplus() / before, 0.3675, 1e-4) << "0.998^500; a time constant of 0.5 s has e^-1 = 0.3679";
    EXPECT_NEAR(observer.returned(), 1e-3, 1e-15) << "returned() does not decay";
}

// 1 N into sand of 100 N/m stores 1² / 200 J = 5 mJ, whatever work the hand has done on the sand.
TEST(GuardFigures, CreditIsWhatTheSandsSpringHolds) {
    PassivityObserver observer = observerOf(0, 100);
    observer.observe({}, kTick);
    observer.sent({1, 0, 0});
    observer.observe({-0.02, 0, 0}, kTick);
    EXPECT_NEAR(observer.surplus(), -0.02, 1e-12) << "20 mJ against the force";
    observer.sent({1, 0, 0});
    EXPECT_NEAR(observer.surplus(), -0.005, 1e-12);
    observer.sent({0, 0.4, 0});
    EXPECT_NEAR(observer.surplus(), -0.0008, 1e-12) << "0.4² / 200 J";
}

TEST(GuardFigures, CreditCountsTheForcesOnTheirWay) {
    PassivityObserver observer = observerOf(0, 100, 0, 2, 1);
    observer.observe({}, kTick);
    observer.sent({1, 0, 0});
    observer.observe({-0.02, 0, 0}, kTick);
    EXPECT_EQ(observer.returned(), 0) << "a tick of delay: no force has acted yet";
    observer.sent({});
    observer.observe({-0.04, 0, 0}, kTick);
    EXPECT_NEAR(observer.returned(), -0.02, 1e-12);
    observer.sent({});
    EXPECT_EQ(observer.surplus(), 0) << "the last force and the one on its way are 0";
    observer.sent({1, 0, 0});
    observer.observe({-0.04, 0, 0}, kTick);
    observer.sent({});
    observer.observe({-0.06, 0, 0}, kTick);
    EXPECT_NEAR(observer.surplus(), -0.02, 1e-12);
    observer.sent({0.6, 0, 0});
    EXPECT_NEAR(observer.surplus(), -0.0018, 1e-12) << "0.6² / 200 J";
}

// Two steps of 0.1 mm under a greatest force of 2 N are 0.4 mJ of noise.
TEST(GuardFigures, TwoStepsOfTheEncoderUnderTheGreatestForceAreNoise) {
    for (const double way : {0.0004, 0.00041}) {  // [m], under 1 N: 0.399 mJ and 0.409 mJ
        PassivityObserver observer = observerOf(0, 0, 1e-4, 2);
        observer.observe({}, kTick);
        observer.sent({1, 0, 0});
        observer.observe({way, 0, 0}, kTick);
        std::uint32_t acted = 0;
        const Vec3 damping = observer.control({0.1, 0, 0}, acted);
        EXPECT_EQ(norm(damping) > 0, way > 0.0004) << way;
        EXPECT_EQ(acted, way > 0.0004 ? bit(Guard::passivity) : 0U) << way;
    }
}

TEST(GuardFigures, AVelocityIsThatOfTheLastFifteenTicksAtMost) {
    VelocityWindow window(1e9);  // any line passes within this resolution, so the window has its greatest length
    Vec3 found;
    for (int tick = 0; tick <= 100; ++tick) {
        // At rest until tick 80, then 1 m/s.
        found = window.add(tick * kTick, {0.001 * std::max(tick - 80, 0), 0, 0});
        const double part = std::clamp((tick - 80) / 15.0, 0.0, 1.0);
        EXPECT_NEAR(found.x, part, 1e-9) << tick;
    }
    EXPECT_NEAR(found.x, 1, 1e-9);
}

}  // namespace
