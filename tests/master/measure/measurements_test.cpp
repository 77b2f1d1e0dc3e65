// SPDX-License-Identifier: Apache-2.0
#include "master/measure/measurements.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace {

using lockstep::Arrival;
using master::ArrivedStep;
using master::Measurements;

constexpr std::int64_t kMs = 1'000'000;  // [ns]

/// Shows frames of a wall of two ranks every `interval` [ns], from frame 1.
class Wall {
public:
    explicit Wall(Measurements& measurements) : measurements_(measurements) {}

    void show(std::int64_t interval, const std::vector<ArrivedStep>& steps = {}, std::int64_t clockOffset = 0) {
        now_ += interval;
        ++frame_;
        std::vector<Arrival> arrivals(3);
        for (std::size_t rank = 0; rank < 3; ++rank) {
            arrivals[rank].frame = frame_;
            arrivals[rank].arrived = now_ - 3 * kMs;
            arrivals[rank].lastSwap = lastSwap_ == 0 ? 0 : lastSwap_ + static_cast<std::int64_t>(rank) * 100'000;
        }
        measurements_.add({frame_, 80, now_ - 5 * kMs, clock_.swapped(now_), held_, rests_}, steps, arrivals,
                          clockOffset);
        lastSwap_ = now_;
    }
    void hold(haptic_bridge::Held held) { held_ = held; }
    void rest(bool rests) { rests_ = rests; }
    [[nodiscard]] std::int64_t now() const { return now_; }
    [[nodiscard]] master::Summary summary() const {
        master::Summary summary;
        measurements_.fill(summary);
        return summary;
    }

private:
    Measurements& measurements_;
    master::FrameClock clock_{100};
    std::uint64_t frame_ = 0;
    haptic_bridge::Held held_ = haptic_bridge::Held::no;
    bool rests_ = false;
    std::int64_t now_ = 50'000 * kMs, lastSwap_ = 0;
};

TEST(Measurements, CountFramesFromSwapToSwapAndThoseThatAreLate) {
    Measurements measurements(3, 0, 0.01, haptic_bridge::Pace::realtime, 60);
    Wall wall(measurements);
    for (const int ms :
         {1000, 10, 10, 14, 16, 10}) {  // the first frame has no frame before it; 16 is more than 1.5 · 10
        wall.show(ms * kMs);
    }
    const master::Summary summary = wall.summary();
    EXPECT_EQ(summary.frameMs.count(), 5U);
    EXPECT_NEAR(summary.frameMs.mean(), 12, 1e-9);
    EXPECT_EQ(summary.lateFrames, 1U);
    EXPECT_EQ(summary.broadcastBytes.count(), 6U);
    EXPECT_EQ(summary.broadcastBytes.mean(), 80);
    EXPECT_NEAR(summary.skewUs.largest(), 100, 1e-9) << "rank 2 swaps 0.1 ms after rank 1";
    EXPECT_EQ(measurements.ranks().frames(), 6U);
}

TEST(Measurements, LeaveOutTheFramesBeforeTheyCount) {
    Measurements measurements(3, 3, 0.01, haptic_bridge::Pace::realtime, 60);
    Wall wall(measurements);
    for (int frame = 1; frame <= 6; ++frame) {
        wall.show(frame <= 4 ? 400 * kMs : 10 * kMs);
    }
    EXPECT_EQ(wall.summary().frameMs.count(), 2U) << "frames 5 and 6: 4 is the first that counts, and has none before";
    EXPECT_NEAR(wall.summary().frameMs.largest(), 10, 1e-9);
    EXPECT_EQ(wall.summary().lateFrames, 0U);
}

TEST(Measurements, CountTheTimeThatAPauseOrAFullDiskHasHeld) {
    using haptic_bridge::Held;
    Measurements measurements(3, 0, 0.01, haptic_bridge::Pace::realtime, 60);
    Wall wall(measurements);
    for (const Held held : {Held::pause, Held::no, Held::pause, Held::disk, Held::disk, Held::disk, Held::no}) {
        wall.hold(held);
        wall.show(250 * kMs);
    }
    EXPECT_NEAR(wall.summary().pausedSeconds, 0.25, 1e-9) << "the first frame has no frame before it";
    EXPECT_NEAR(wall.summary().fullDiskSeconds, 0.75, 1e-9);
}

TEST(Measurements, CountTheTimeWithoutStepsBecauseNothingMovesAndNoPauseTwice) {
    using haptic_bridge::Held;
    Measurements measurements(3, 0, 0.01, haptic_bridge::Pace::realtime, 60);
    Wall wall(measurements);
    wall.show(250 * kMs);
    wall.rest(true);
    for (const Held held : {Held::no, Held::no, Held::no, Held::pause}) {
        wall.hold(held);
        wall.show(250 * kMs);
    }
    wall.rest(false);
    wall.hold(Held::no);
    wall.show(250 * kMs);
    EXPECT_NEAR(wall.summary().restSeconds, 0.75, 1e-9);
    EXPECT_NEAR(wall.summary().pausedSeconds, 0.25, 1e-9);
}

TEST(Measurements, OfAFastSessionKnowNoLateFrame) {
    Measurements measurements(3, 0, 0.01, haptic_bridge::Pace::fast, 60);
    Wall wall(measurements);
    wall.show(10 * kMs);
    wall.show(500 * kMs);
    EXPECT_EQ(wall.summary().lateFrames, 0U);
}

// The server read this step 12 ms before the swap on the master's clock. The server's clock is 7 s ahead.
TEST(Measurements, FollowAStepFromTheHandToTheWall) {
    constexpr std::int64_t kAhead = 7'000 * kMs;
    Measurements measurements(3, 0, 0.01, haptic_bridge::Pace::realtime, 60);
    Wall wall(measurements);
    wall.show(10 * kMs);
    std::vector<ArrivedStep> steps(2);
    const std::int64_t swap = wall.now() + 20 * kMs;
    steps[0].serverTimeNs = swap - 12 * kMs + kAhead;
    steps[0].receivedNs = swap - 11 * kMs;
    wall.show(20 * kMs, steps, kAhead);  // the master made the second step
    const master::Latency latency = wall.summary().latency;
    ASSERT_EQ(latency.wholeWay.count(), 1U);
    EXPECT_NEAR(latency.toMaster.mean(), 1, 1e-9);
    EXPECT_NEAR(latency.queued.mean(), 6, 1e-9) << "broadcast 5 ms before the swap";
    EXPECT_NEAR(latency.drawn.mean(), 2, 1e-9) << "all ranks have come 3 ms before it";
    EXPECT_NEAR(latency.swapped.mean(), 3, 1e-9);
    EXPECT_NEAR(latency.wholeWay.mean(), 12, 1e-9);
}

TEST(Measurements, SayHowManyFramesASecondHas) {
    Measurements measurements(3, 0, 0.01, haptic_bridge::Pace::realtime, 60);
    constexpr std::int64_t kStart = 1'000'000 * kMs;
    measurements.printProgress({.frame = 1, .step = 1}, kStart);
    measurements.printProgress({.frame = 31, .step = 31}, kStart + 500 * kMs);
    nlohmann::json status;
    measurements.describe(status, {});
    EXPECT_EQ(status["fps"], 0) << "less than a second has passed";
    measurements.printProgress({.frame = 91, .step = 91}, kStart + 1500 * kMs);
    measurements.describe(status, {});
    EXPECT_NEAR(status["fps"].get<double>(), 60, 1e-9);
    EXPECT_EQ(status["slowest"], nullptr);
}

/// A wall of 60 Hz that prints its lines of progress.
class Lines {
public:
    /// Shows frames for so many seconds, whose steps stay at `step`. Returns how many lines they print.
    std::ptrdiff_t showAt(std::uint64_t step, int seconds, const char* hand = "no hand") {
        testing::internal::CaptureStdout();
        for (int i = 0; i < 60 * seconds; ++i) {
            nowNs_ += 1'000'000'000 / 60 + 1;
            measurements_.printProgress({.frame = ++frame_, .step = step, .hand = hand, .repeat = 60}, nowNs_);
        }
        const std::string printed = testing::internal::GetCapturedStdout();
        return std::count(printed.begin(), printed.end(), '\n');
    }
    [[nodiscard]] double framesPerSecond() const {
        nlohmann::json status;
        measurements_.describe(status, {});
        return status["fps"];
    }

private:
    Measurements measurements_{3, 0, 1.0 / 60, haptic_bridge::Pace::realtime, 60};
    std::uint64_t frame_ = 0;
    std::int64_t nowNs_ = 1'000'000 * kMs;
};

// The log of an untouched wall must not grow by a line each second.
TEST(Measurements, PrintALineAMinuteWhileNeitherStepNorHandChanges) {
    Lines lines;
    std::ptrdiff_t moving = 0;
    for (std::uint64_t step = 60; step <= 600; step += 60) {
        moving += lines.showAt(step, 1);
    }
    EXPECT_EQ(moving, 10) << "a line a second";
    EXPECT_EQ(lines.showAt(600, 600), 10) << "ten minutes";
    EXPECT_NEAR(lines.framesPerSecond(), 60, 0.1) << "the rate is counted each second";
    EXPECT_EQ(lines.showAt(601, 2), 1) << "a step";
    EXPECT_EQ(lines.showAt(601, 2, "hand points"), 1) << "another hand";
}

// Frames per second: 30 in the second of the start, which is left out, then 60, 62, 40, 40 and 5 in the end.
TEST(Measurements, TellAPersonWhoDigsOnlyOfARateThatHasChanged) {
    Measurements measurements(3, 0, 0.01, haptic_bridge::Pace::realtime, 60);
    testing::internal::CaptureStdout();
    std::uint64_t frame = 1;
    std::int64_t now = 1'000'000 * kMs;
    const auto print = [&](bool last) {
        measurements.printProgress({.frame = frame, .step = frame, .hand = "hand points", .last = last}, now,
                                   Measurements::Reader::digs);
    };
    print(false);
    for (const std::uint64_t rate : {30U, 60U, 62U, 40U, 40U}) {
        frame += rate;
        now += 1000 * kMs;
        print(false);
    }
    frame += 5;
    print(true);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "60 pictures a second\n40 pictures a second\n");
}

/// A tool that takes a frame of 100 ms for each 10 ms of the hand's path.
TEST(Measurements, ReportTheSlowMotionOfTheTool) {
    for (const auto pace : {haptic_bridge::Pace::realtime, haptic_bridge::Pace::fast}) {
        Measurements measurements(3, 0, 0.01, pace, 60);
        Wall wall(measurements);
        wall.show(10 * kMs);
        for (int frame = 0; frame <= 10; ++frame) {
            ArrivedStep timed;
            timed.serverTimeNs = (100 + 10 * frame) * kMs;
            timed.step.engaged = true;
            timed.step.path = {{frame, 0, 0}};
            wall.show(100 * kMs, {timed});
        }
        nlohmann::json status;
        measurements.describe(status, {"the master", "rank 1", "rank 2"});
        if (pace == haptic_bridge::Pace::fast) {
            EXPECT_EQ(status["slow_motion"], nullptr) << "the hand waits for the sand";
            EXPECT_EQ(wall.summary().hand.slowMotion, std::nullopt);
        } else {
            EXPECT_DOUBLE_EQ(status["slow_motion"].get<double>(), 10);
            EXPECT_DOUBLE_EQ(wall.summary().hand.slowMotion.value(), 10);
        }
    }
}

TEST(Measurements, TellTheWallWhatItsRanksCannotKnow) {
    Measurements measurements(3, 0, 0.01, haptic_bridge::Pace::realtime, 60);
    Wall wall(measurements);
    wall.show(10 * kMs);
    wall.show(11 * kMs);
    master::Incidents incidents;
    incidents.divergences = 4;
    incidents.healed = 3;
    const lockstep::WallFigures figures = measurements.figures(incidents, 70);
    EXPECT_NEAR(figures.frameMs, 11, 1e-9);
    EXPECT_EQ(figures.agreed, 2U);
    EXPECT_EQ(figures.divergences, 4U);
    EXPECT_EQ(figures.healed, 3U);
    EXPECT_EQ(figures.sweepsOwed, 70);
    EXPECT_EQ(figures.slowMotion, std::nullopt) << "no hand has moved the tool";
    EXPECT_EQ(figures.swaps, (std::vector<std::uint32_t>{0, 100}));
}

}  // namespace
