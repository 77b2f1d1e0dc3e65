// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/step_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "haptic_bridge/client/clock_offset.hpp"

namespace {

using haptic_bridge::StepClock;

constexpr std::int64_t kSecond = 1'000'000'000;

/// Runs steps at a nominal 60 per second against a wall of `frameHz`, with a swap every 1/frameHz. Returns how many
/// steps each frame of the last half of `seconds` found.
std::vector<int> stepsPerFrame(double frameHz, int seconds) {
    StepClock clock(60);
    clock.start(0);
    const auto interval = static_cast<std::int64_t>(kSecond / frameHz);
    std::vector<int> counts;
    for (std::int64_t swap = interval; swap < seconds * kSecond; swap += interval) {
        int steps = 0;
        for (; clock.due() <= swap; ++steps) {
            clock.advance(clock.due());
        }
        clock.frameShown(swap, interval);
        if (swap > seconds * kSecond / 2) {
            counts.push_back(steps);
        }
    }
    return counts;
}

TEST(StepClock, FollowsAWallOfNearlyItsRate) {
    for (const double hertz : {58.0, 59.94, 60.0, 60.7, 62.0}) {
        const auto counts = stepsPerFrame(hertz, 60);
        EXPECT_TRUE(std::all_of(counts.begin(), counts.end(), [](int n) { return n == 1; }))
            << hertz << " Hz: every frame must find exactly one step";
    }
}

TEST(StepClock, KeepsItsRateBesideAWallOfAnother) {
    for (const double hertz : {24.0, 30.0, 50.0, 75.0, 120.0}) {
        const auto counts = stepsPerFrame(hertz, 60);
        int steps = 0;
        for (const int count : counts) {
            steps += count;
        }
        const double seconds = static_cast<double>(counts.size()) / hertz;
        EXPECT_NEAR(steps / seconds, 60.0, 0.1) << hertz << " Hz";
    }
}

TEST(StepClock, RunsFreeWhenTheWallStops) {
    StepClock clock(60);
    clock.start(0);
    clock.frameShown(0, kSecond / 59);
    int steps = 0;
    for (; clock.due() < 100 * kSecond; ++steps) {
        clock.advance(clock.due());
    }
    EXPECT_NEAR(steps, 6000, 2);
}

TEST(StepClock, DoesNotCatchUpAfterAPause) {
    StepClock clock(60);
    clock.start(0);
    clock.advance(10 * kSecond);
    EXPECT_GT(clock.due(), 10 * kSecond);
}

TEST(ClockOffset, BelievesTheShortestRoundTrip) {
    haptic_bridge::ClockOffset clock;
    EXPECT_EQ(clock.offsetNs(), 0);
    constexpr std::int64_t kAhead = 5'000'000;
    clock.add(0, 900'000 + kAhead, 1'000'000);  // the way to the server took nine tenths of the round trip
    EXPECT_EQ(clock.offsetNs(), kAhead + 400'000);
    clock.add(0, 50'000 + kAhead, 100'000);
    EXPECT_EQ(clock.offsetNs(), kAhead);
    clock.add(0, 10'000 + kAhead, 2'000'000);
    EXPECT_EQ(clock.offsetNs(), kAhead);
    EXPECT_EQ(clock.roundTripNs(), 100'000);
}

}  // namespace
