// SPDX-License-Identifier: Apache-2.0
#include "master/steps/tick_budget.hpp"

#include <gtest/gtest.h>

#include "haptic_bridge/loop/tick_track.hpp"

namespace {

using master::TickBudget;

constexpr std::int64_t kMillisecondOfTicks = 1'000'000;  // [ns]

haptic_bridge::TickInput tickAt(std::int64_t ns) {
    haptic_bridge::TickInput tick;
    tick.nowNs = ns;
    tick.surfaceAgeNs = 16 * kMillisecondOfTicks;
    tick.surfaceStep = 1'000'000;
    tick.surfaceProbe = {static_cast<std::int32_t>(ns % sand::kMaxProbe), -sand::kMaxProbe, 0};
    return tick;
}

/// Returns the bytes of a piece as the recorder of a hand makes it every 5 ms.
std::size_t fiveTicks(std::int64_t ns) {
    haptic_bridge::TrackPiece piece;
    for (int i = 0; i < 5; ++i) {
        piece.ticks.push_back(tickAt(ns + i * kMillisecondOfTicks));
    }
    return encode(piece).size();
}

TEST(TickBudget, IsEnoughForAHandInRealTime) {
    std::int64_t now = 9'000'000'000'000'000'000;
    TickBudget budget(0, now);
    for (int piece = 0; piece < 200 * 3600; ++piece) {
        now += 5 * kMillisecondOfTicks;
        ASSERT_TRUE(budget.take(fiveTicks(now), now)) << piece;
    }
}

// The recorder keeps its pieces while the wall makes no steps. 4096 pieces are 20 s of a hand, and more than it keeps.
TEST(TickBudget, IsEnoughForAHandThatWaited) {
    std::int64_t now = 0;
    TickBudget budget(0, now);
    for (int time = 0; time < 10; ++time) {
        now += 4096 * 5 * kMillisecondOfTicks;
        for (int piece = 0; piece < 4096; ++piece) {
            ASSERT_TRUE(budget.take(fiveTicks(now), now)) << time << ' ' << piece;
        }
    }
}

// Under the fast pace the steps come as fast as the wall can show them. The ticks come first, up to a window ahead.
TEST(TickBudget, IsEnoughForAHandUnderTheFastPace) {
    for (const int rate : {1, 10, 60, 1000}) {
        TickBudget budget(rate, 0);
        for (int step = 0; step < 1000; ++step) {
            for (int tick = 0; tick < 1000 / rate; tick += 5) {
                ASSERT_TRUE(budget.take(fiveTicks(0), 0)) << rate << ' ' << step;
            }
            if (step >= 8) {
                budget.step();
            }
        }
    }
}

// A server could otherwise send steps to double what it may send of ticks.
TEST(TickBudget, DoesNotGrowWithStepsInRealTime) {
    TickBudget budget(0, 0);
    double kept = 0;
    for (int i = 0; i < 10'000; ++i) {
        budget.step();
        kept += budget.take(65'000, 0) ? 65'000 : 0;
    }
    EXPECT_LE(kept, TickBudget::kBurst);
}

TEST(TickBudget, RefusesAndCountsWhatIsMore) {
    TickBudget budget(0, 0);
    double kept = 0;
    for (int i = 0; i < 10'000; ++i) {
        kept += budget.take(65'000, 1'000'000'000) ? 65'000 : 0;
    }
    EXPECT_LE(kept, TickBudget::kBurst);
    EXPECT_GT(kept, TickBudget::kBurst - 2 * 65'000);
    EXPECT_EQ(budget.refused(), 10'000 - static_cast<std::uint64_t>(kept / 65'000));
    EXPECT_TRUE(budget.take(65'000, 3'000'000'000)) << "two seconds later";
}

TEST(TickBudget, CountsEmptyPieces) {
    TickBudget budget(0, 0);
    int kept = 0;
    for (int i = 0; i < 100'000; ++i) {
        kept += budget.take(0, 0) ? 1 : 0;
    }
    EXPECT_LT(kept, 100'000);
}

}  // namespace
