// SPDX-License-Identifier: Apache-2.0
#include "master/steps/slow_motion.hpp"

#include <gtest/gtest.h>

namespace {

using master::ArrivedStep;
using master::SlowMotion;

constexpr std::int64_t kMs = 1'000'000, kFrame = 16 * kMs;  // [ns]

/// Returns a step whose last sample was read at `readNs`.
ArrivedStep stepAt(std::int64_t readNs, bool engaged, bool moves = true, std::uint32_t epoch = 1) {
    ArrivedStep timed;
    timed.serverTimeNs = readNs;
    timed.step.epoch = epoch;
    timed.step.engaged = engaged;
    if (moves) {
        timed.step.path = {{1, 2, 3}};
    }
    return timed;
}

/// A stroke of which each frame takes the movement of a frame.
TEST(SlowMotion, OfAToolThatKeepsUpIsOne) {
    SlowMotion motion(60);
    std::int64_t now = 1000 * kMs;
    for (int stroke = 0; stroke < 3; ++stroke) {
        for (int frame = 0; frame < 20; ++frame, now += kFrame) {
            motion.add(kFrame, {stepAt(now, frame < 15)});
        }
    }
    EXPECT_DOUBLE_EQ(motion.factor().value(), 1);
}

TEST(SlowMotion, CountsTheWaitForSweepsThatAreOwed) {
    SlowMotion motion(60);
    motion.add(kFrame, {stepAt(1000 * kMs, true)});
    for (std::int64_t step = 1; step <= 20; ++step) {
        motion.add(kFrame, {stepAt(1000 * kMs + step * kFrame, true)});
        motion.add(3 * kFrame, {stepAt(0, true, false)});  // it only pays
    }
    EXPECT_DOUBLE_EQ(motion.factor().value(), 4);
}

TEST(SlowMotion, LeavesOutMovementThatWasDropped) {
    SlowMotion motion(50);
    motion.add(kFrame, {stepAt(1000 * kMs, true)});
    motion.add(800 * kMs, {stepAt(1800 * kMs, false)});  // a path holds four periods of 20 ms
    EXPECT_DOUBLE_EQ(motion.factor().value(), 10);
}

TEST(SlowMotion, TakesAHandAtRestForNoneThatWaits) {
    SlowMotion motion(60);
    motion.add(kFrame, {stepAt(1000 * kMs, true)});
    motion.add(800 * kMs, {stepAt(1800 * kMs, true, false)});
    EXPECT_DOUBLE_EQ(motion.factor().value(), 1);
}

/// The master makes no steps while a tool that is held in the sand rests. A minute later the hand moves it again.
TEST(SlowMotion, OfAToolThatKeepsUpIsOneAlsoAfterARest) {
    SlowMotion motion(60);
    motion.add(kFrame, {stepAt(1000 * kMs, true)});
    for (std::int64_t frame = 1; frame <= 3600; ++frame) {
        motion.addRest(kFrame);
    }
    motion.add(kFrame, {stepAt(1000 * kMs + 3601 * kFrame, true)});
    EXPECT_DOUBLE_EQ(motion.factor().value(), 1);
    motion.add(3600 * kFrame, {stepAt(1000 * kMs + 7201 * kFrame, true)});
    EXPECT_GT(motion.factor().value(), 1) << "of a longer time without steps, movement was dropped";
}

TEST(SlowMotion, NeedsHalfASecondOfAHandInTheSand) {
    SlowMotion motion(60);
    for (std::int64_t frame = 0; frame < 100; ++frame) {
        motion.add(kFrame, {stepAt(frame * kFrame + kMs, false)});  // it hovers
        motion.add(kFrame, {stepAt(0, true, false)});               // a recording has no hand
    }
    EXPECT_EQ(motion.factor(), std::nullopt);
    motion.add(kFrame, {stepAt(5000 * kMs, true)});
    motion.add(490 * kMs, {stepAt(5490 * kMs, true)});
    EXPECT_EQ(motion.factor(), std::nullopt);
    motion.add(10 * kMs, {stepAt(5500 * kMs, true)});
    EXPECT_TRUE(motion.factor());
}

/// The master's clock has nothing to do with that of the server whose epoch has ended.
TEST(SlowMotion, ComparesNoTimesOfTwoEpochs) {
    SlowMotion motion(60);
    motion.add(kFrame, {stepAt(1000 * kMs, true)});
    motion.add(600 * kMs, {stepAt(1600 * kMs, true, false)});
    motion.add(0, {stepAt(9'000'000 * kMs, true, false, 2)});
    EXPECT_DOUBLE_EQ(motion.factor().value(), 1);
}

/// A step of the master has its own time of the hand, also if its latency is not measured.
TEST(SlowMotion, ReadsTheHandOfTheMastersSteps) {
    SlowMotion motion(60);
    for (std::int64_t frame = 0; frame <= 60; ++frame) {
        ArrivedStep own = stepAt(0, true);
        own.handNs = 1000 * kMs + frame * kFrame / 2;
        motion.add(kFrame, {own});
    }
    EXPECT_DOUBLE_EQ(motion.factor().value(), 2);
}

}  // namespace
