// SPDX-License-Identifier: Apache-2.0
// Whole hands in moving sand with each way of `between`. `sandwall-bench between-stability` prints the figures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/hand/hand_in_sand.hpp"

namespace {

using haptic_bridge::Grip;
using sand::Between;
using test::DiggingHand;

constexpr double kInTime = 3;  // [s], time in which an arm must come to rest

/// Calls `check` with a hand that holds still in the sand. Tries each way of `between`, each arm and each grip.
template <class Check>
void forEachHand(std::initializer_list<Between> ways, const Check& check) {
    for (const Between between : ways) {
        const scene::Scene scene = test::writingSand(between);
        for (const std::string_view name : haptic_bridge::kArmPresets) {
            for (const Grip& grip : {test::kLightGrip, test::kUsualGrip}) {
                SCOPED_TRACE(
                    fmt::format("between {}, {}, grip {} N/m", static_cast<int>(between), name, grip.stiffness));
                DiggingHand hand(scene, *haptic_bridge::armPreset(name), grip);
                hand.runUntilItHolds();
                check(hand);
            }
        }
    }
}

/// Expects that the arm comes to rest from now on, and that the sand still pushes it. Returns the force at rest [N].
double expectRest(DiggingHand& hand) {
    EXPECT_LT(test::restsAfter(hand.run(6)), kInTime);
    EXPECT_GT(hand.sent(), 0) << "a loop that pushes nothing would also rest";
    return hand.sent();
}

TEST(BetweenStability, EveryArmRestsInMovingSandHoweverTheForceIsHeld) {
    int hands = 0;
    forEachHand({Between::local, Between::hold, Between::interpolate}, [&](DiggingHand& hand) {
        (void)expectRest(hand);
        ++hands;
    });
    EXPECT_EQ(hands, 24);
}

/// An arm bears b/(T_h/2 + t_d), and a step that is 150 ms old makes T_h 9 times as long. With t_d = 1 ms, 0.123 of the
/// stiffness is left with `hold`, and 0.115 with `interpolate`. The law's force stays that of the last step.
TEST(BetweenStability, ALateStepLowersTheForceAndTheArmRestsAgain) {
    forEachHand({Between::hold, Between::interpolate}, [&](DiggingHand& hand) {
        const double before = expectRest(hand);
        hand.loop().paused = true;
        (void)hand.run(0.15);
        EXPECT_LT(hand.sent(), 0.13 * before);
        EXPECT_GT(hand.sent(), 0.1 * before);
        hand.loop().paused = false;
        (void)expectRest(hand);
    });
}

/// With 30 steps a second 0.528 of K is left with `hold`, and 0.510 with `interpolate`. Until the next step it rises by
/// 0.03. Grip and sand are two springs in a row, so the force falls to 0.56 (k + K)/(k + 0.56 K) of itself or less.
/// That is 0.75 for the softest grip k = 100 N/m on the stiffest sand K = 134 N/m.
TEST(BetweenStability, StepsAtHalfRateLowerTheForceAndTheArmRestsAgain) {
    forEachHand({Between::hold, Between::interpolate}, [&](DiggingHand& hand) {
        const double before = expectRest(hand);
        hand.loop().stepsPerSecond = 30;
        EXPECT_LT(expectRest(hand), 0.75 * before);
    });
}

}  // namespace
