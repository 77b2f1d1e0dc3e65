// SPDX-License-Identifier: Apache-2.0
// The stiffness that an arm bears when a force is held from step to step, by hand: K is half of b / (T/2 + t_d). T is
// the time of a step for a held force, and three steps for an interpolated one.
#include <gtest/gtest.h>

#include <limits>

#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "haptic_bridge/loop/guards/late_step.hpp"

namespace {

using namespace haptic_bridge;
using sand::Between;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// An arm of b = 2 N·s/m and a delay of 1 ms, under 50 steps per second. Its friction holds it between two steps of an
/// encoder.
ForceLimits timed(Between between, double maxStiffness = kNever, double lawStiffness = 100) {
    ArmPhysics arm;
    arm.name = "timed";
    arm.mass = 0.2;
    arm.damping = 2;
    arm.friction = 1;
    arm.resolution = 2e-5;
    arm.maxForce = 8;
    arm.reach = 0.06;
    arm.maxStiffness = maxStiffness;
    arm.delayTicks = 1;
    return ForceLimits::of(arm, 1, {lawStiffness, 66, 5}, 0.67, 0, {between, 50});
}

TEST(StepTiming, AHeldForceBearsLessStiffness) {
    EXPECT_NEAR(timed(Between::local).stiffness, 666.6667, 1e-3) << "2 / 1.5 ms / 2";
    EXPECT_NEAR(timed(Between::hold).stiffness, 90.90909, 1e-4) << "2 / (10 + 1) ms / 2";
    EXPECT_NEAR(timed(Between::interpolate).stiffness, 32.25806, 1e-4) << "2 / (30 + 1) ms / 2";
    EXPECT_NEAR(timed(Between::hold, 100).stiffness, 50, 1e-9) << "half of what the maker allows";
    EXPECT_NEAR(timed(Between::hold).gain, 90.90909 / 100, 1e-6) << "the law asks for 100 N/m";
    EXPECT_NEAR(timed(Between::hold).slew, 90.90909 * 2e-3, 1e-6);
}

TEST(StepTiming, ALateStepLowersWhatTheArmBears) {
    const ForceLimits held = timed(Between::hold), between = timed(Between::interpolate);
    for (const double age : {0.0, 0.02}) {
        EXPECT_EQ(held.shareForStepOf(age), 1) << "no step is late";
        EXPECT_EQ(between.shareForStepOf(age), 1);
    }
    EXPECT_NEAR(held.shareForStepOf(0.06), 11.0 / 31, 1e-9) << "10 + 1 ms become 30 + 1";
    EXPECT_NEAR(between.shareForStepOf(0.06), 31.0 / 91, 1e-9) << "30 + 1 ms become 90 + 1";
    // The maker's 100 N/m are less than 2 / 11 ms, and more than 2 / 31 ms = 64.5 N/m.
    EXPECT_NEAR(timed(Between::hold, 100).shareForStepOf(0.06), 0.6451613, 1e-6);
    for (const double age : {kNever, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_EQ(held.shareForStepOf(age), 0);
        EXPECT_EQ(timed(Between::local).shareForStepOf(age), 1) << "computed again at every tick";
    }
}

TEST(StepTiming, IsNamedInTheWordsOfTheLimits) {
    const LawAtRadius law{100, 66, 5};
    const std::string damping = "half of what 2 N s/m of damping";
    EXPECT_EQ(
        timed(Between::hold).inWords("k_s", 1000, law),
        (std::vector<std::string>{
            "k_s 1000 → 910: timed at 1 scene units per metre; the law asks for 100 N/m, the limit is 90.9 N/m, " +
                damping + ", a force held for steps of 20 ms and 1 tick of delay allow",
            // 66/60 N s/m times 0.909; 0.2 kg / 9 ms; 90.9 N/m times 2 mm.
            "friction 1 N s/m at one radius' depth, at most 22 N s/m and 0.67 of the push; at most 8 N, growing by "
            "at most 0.18 N per tick"}));
    const auto reason = [&](const ForceLimits& limits) {
        const std::string words = limits.inWords("k_s", 1000, law).front();
        return words.substr(words.find("N/m, the limit is ") + 18);
    };
    EXPECT_EQ(reason(timed(Between::interpolate)),
              "32.3 N/m, " + damping + ", an interpolation over steps of 20 ms and 1 tick of delay allow");
    EXPECT_EQ(reason(timed(Between::local)), "667 N/m, " + damping + " and 1 tick of delay allow");
    EXPECT_EQ(reason(timed(Between::hold, 100)), "50 N/m, half of what its maker allows");
    ArmPhysics loose = timed(Between::local).arm;
    loose.friction = 0;
    // 0.6 · 1 mm/s · π/2 · √(1333.3 N/m · 0.2 kg) / 20 µm is 769.5 N/m; 0.1 mm give 153.9 N/m, less than 666.7.
    loose.resolution = 1e-4;
    EXPECT_EQ(reason(ForceLimits::of(loose, 1, law, 0.67)),
              "154 N/m, at which it rests despite its encoder's step of 100 um");
}

/// Returns the factor after `ticks` of 1 ms with a newest step of that age.
double after(LateStep& late, int ticks, double age) {
    double factor = 1;
    for (int tick = 0; tick < ticks; ++tick) {
        factor = late.next(1e-3, age);
    }
    return factor;
}

// 11/31 while a held step is 60 ms old. Half of the way back to 1 is 21/31.
TEST(LateStep, FallsAtOnceAndRisesOverHalfASecond) {
    const ForceLimits limits = timed(Between::hold);
    LateStep late(limits);
    EXPECT_EQ(after(late, 100, 0.02), 1);
    EXPECT_NEAR(after(late, 1, 0.06), 11.0 / 31, 1e-9);
    EXPECT_NEAR(after(late, 250, 0), 21.0 / 31, 1e-9);
    // 2 / (15 + 1) ms / 2 is 62.5 N/m, or 11/16. This is more than the factor has risen to.
    EXPECT_NEAR(after(late, 1, 0.03), 21.0 / 31 + 20.0 / 31 / 500, 1e-9);
    EXPECT_NEAR(after(late, 1, 0.06), 11.0 / 31, 1e-9) << "it falls again";
    EXPECT_LT(after(late, 495, 0), 1);
    EXPECT_EQ(after(late, 10, 0), 1);
    EXPECT_EQ(after(late, 1, kNever), 0);
}

TEST(LateStep, IsNothingForAForceThatIsComputedAnewAtEveryTick) {
    const ForceLimits limits = timed(Between::local);
    LateStep late(limits);
    for (const double age : {0.0, 0.06, 10.0, kNever}) {
        EXPECT_EQ(after(late, 2, age), 1) << age;
    }
}

TEST(LateStep, ATimeThatIsNoNumberDoesNotPass) {
    const ForceLimits limits = timed(Between::hold);
    LateStep late(limits);
    (void)after(late, 1, 0.06);
    for (const double span : {std::numeric_limits<double>::quiet_NaN(), -5.0}) {
        EXPECT_NEAR(late.next(span, 0), 11.0 / 31, 1e-9);
    }
    EXPECT_NEAR(after(late, 250, 0), 21.0 / 31, 1e-9);
}

}  // namespace
