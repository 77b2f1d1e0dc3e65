// SPDX-License-Identifier: Apache-2.0
// The shares of the force that clutch, operators and sand without steps leave, tick by tick.
#include "haptic_bridge/loop/guards/felt_share.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "haptic_bridge/loop/guards/frozen_sand.hpp"

namespace {

using haptic_bridge::FeltShare;
using haptic_bridge::FrozenSand;

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

/// Returns the share after `ticks` of 1 ms.
double after(FeltShare& share, int ticks, double wanted) {
    double felt = 0;
    for (int tick = 0; tick < ticks; ++tick) {
        felt = share.next(1e-3, wanted);
    }
    return felt;
}

TEST(FeltShare, BeginsWithTheShareOfItsFirstTick) {
    EXPECT_EQ(FeltShare().next(0, 1), 1);
    EXPECT_EQ(FeltShare().next(0, 0.3), 0.3);
    EXPECT_EQ(FeltShare().next(0, 7), 1) << "at most the whole force";
    EXPECT_EQ(FeltShare().next(0, -7), 0);
}

TEST(FeltShare, FallsWithinATwentiethAndGrowsWithinHalfASecond) {
    FeltShare share;
    (void)share.next(0, 1);
    EXPECT_NEAR(after(share, 25, 0), 0.5, 1e-9);
    EXPECT_NEAR(after(share, 25, 0), 0, 1e-9);
    EXPECT_EQ(after(share, 1, 0), 0);
    EXPECT_NEAR(after(share, 250, 1), 0.5, 1e-9);
    EXPECT_NEAR(after(share, 100, 0.6), 0.6, 1e-9) << "it stops at the share that is wanted";
    EXPECT_EQ(after(share, 201, 1), 1);
    EXPECT_NEAR(after(share, 10, 0.4), 0.8, 1e-9) << "a part of the way takes a part of the time";
}

TEST(FeltShare, ALateTickCountsAsFiftyMilliseconds) {
    FeltShare share;
    (void)share.next(0, 0);
    EXPECT_NEAR(share.next(10, 1), 0.1, 1e-12);
    EXPECT_NEAR(share.next(-10, 1), 0.1, 1e-12) << "a clock that runs backwards";
}

TEST(FeltShare, ANumberThatIsNoneIsForgottenAfterItsTick) {
    FeltShare share;
    (void)share.next(0, 1);
    EXPECT_EQ(share.next(kNoTime, 0.5), 1) << "no time has passed";
    EXPECT_NEAR(after(share, 25, kNoTime), 0.5, 1e-9) << "it falls as to a share of 0";
    EXPECT_EQ(after(share, 300, 1), 1);
    EXPECT_EQ(FeltShare().next(0, kNoTime), 0);
}

/// Returns the share of the force after `ticks` of 1 ms with a newest step of that age.
double after(FrozenSand& sand, int ticks, double age) {
    double share = 1;
    for (int tick = 0; tick < ticks; ++tick) {
        share = sand.next(1e-3, age);
    }
    return share;
}

TEST(FrozenSand, BeginsAfterAQuarterOfASecondOrThreeSteps) {
    struct Row {
        double stepsPerSecond, oldest;  // [1/s], [s]
    };
    for (const auto& [stepsPerSecond, oldest] :
         {Row{240, 0.25}, Row{60, 0.25}, Row{13, 0.25}, Row{5, 0.6}, Row{1, 3}}) {
        FrozenSand sand(1 / stepsPerSecond);
        EXPECT_EQ(after(sand, 3000, oldest - 1e-6), 1) << stepsPerSecond;
        EXPECT_NEAR(after(sand, 1, oldest + 1e-6), 0.99, 1e-9) << stepsPerSecond;
    }
}

TEST(FrozenSand, FadesWithinATenthOfASecond) {
    FrozenSand sand(1.0 / 60);
    EXPECT_NEAR(after(sand, 50, 0.3), 0.5, 1e-9);
    EXPECT_NEAR(after(sand, 50, 0.3), 0, 1e-9);
    EXPECT_EQ(after(sand, 1000, 5), 0);
}

TEST(FrozenSand, CompletesAFadeAlthoughAStepComesMeanwhile) {
    FrozenSand sand(1.0 / 60);
    EXPECT_NEAR(after(sand, 30, 0.3), 0.7, 1e-9);
    EXPECT_NEAR(after(sand, 30, 0), 0.4, 1e-9);
    EXPECT_NEAR(after(sand, 40, 0), 0, 1e-9);
}

// The second of steps may end a tick early or late, because a sum of milliseconds is rounded.
TEST(FrozenSand, ComesBackInHalfASecondWhenStepsHaveComeForASecond) {
    FrozenSand sand(1.0 / 60);
    (void)after(sand, 200, 0.3);
    EXPECT_EQ(after(sand, 998, 0.016), 0);
    EXPECT_NEAR(after(sand, 252, 0.016), 0.5, 0.005);
    EXPECT_LT(after(sand, 245, 0.016), 1);
    EXPECT_EQ(after(sand, 10, 0.016), 1);
}

TEST(FrozenSand, AnOldStepBeginsTheSecondAnew) {
    FrozenSand sand(1.0 / 60);
    (void)after(sand, 200, 0.3);
    (void)after(sand, 900, 0);
    (void)after(sand, 1, 0.3);
    EXPECT_EQ(after(sand, 998, 0), 0);
    EXPECT_GT(after(sand, 10, 0), 0);
    // In the ramp, too.
    EXPECT_NEAR(after(sand, 5, 0.3), 0, 0.02);
    EXPECT_EQ(after(sand, 998, 0), 0);
}

TEST(FrozenSand, AnAgeThatIsNoNumberIsOldAndATimeThatIsNoneDoesNotPass) {
    FrozenSand sand(1.0 / 60);
    EXPECT_NEAR(after(sand, 50, kNoTime), 0.5, 1e-9);
    EXPECT_NEAR(sand.next(kNoTime, 0), 0.5, 1e-9);
    EXPECT_NEAR(sand.next(-5, 0), 0.5, 1e-9);
    EXPECT_EQ(after(sand, 1600, 0), 1) << "it is forgotten after its tick";
}

}  // namespace
