// SPDX-License-Identifier: Apache-2.0
#include "lockstep/rank_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace {

using lockstep::Arrival;
using lockstep::RankStatistics;

constexpr int kRanks = 12;

/// Returns the arrivals of one frame. The master comes first, then one render rank at each time of `ms` [ms].
std::vector<Arrival> frameOf(const std::vector<double>& ms) {
    std::vector<Arrival> arrivals(1);
    for (const double at : ms) {
        Arrival& arrival = arrivals.emplace_back();
        arrival.arrived = static_cast<std::int64_t>(at * 1e6);
    }
    return arrivals;
}

/// Returns the arrivals at a still wall. All ranks come within 0.8 ms, except rank `slow`, which comes later by `late`
/// [ms].
std::vector<Arrival> stillFrame(std::mt19937& random, std::size_t slow, double late) {
    std::vector<double> ms;
    for (std::size_t rank = 1; rank <= kRanks; ++rank) {
        ms.push_back(1 + 0.8 * static_cast<double>(random() % 1000) / 1000 + (rank == slow ? late : 0));
    }
    return frameOf(ms);
}

TEST(RankStatistics, NameTheOneThatAStillWallWaitsFor) {
    std::mt19937 random(5);
    RankStatistics statistics(kRanks + 1);
    for (int frame = 0; frame < 300; ++frame) {
        statistics.add(stillFrame(random, 5, 30), true);
    }
    const auto drag = statistics.drag();
    ASSERT_TRUE(drag.has_value());
    EXPECT_EQ(drag->rank, 5);
    EXPECT_EQ(drag->share, 1);
    EXPECT_NEAR(drag->keptMs, 30, 1);
    ASSERT_TRUE(statistics.recentDrag().has_value());
    EXPECT_EQ(statistics.recentDrag()->rank, 5);
    EXPECT_EQ(statistics.ranks()[5].keptMs.count(), 300U);
    EXPECT_EQ(statistics.ranks()[4].keptMs.count(), 0U);
}

TEST(RankStatistics, AccuseNobodyOnAStillWall) {
    std::mt19937 random(6);
    RankStatistics statistics(kRanks + 1);
    for (int frame = 0; frame < 300; ++frame) {
        statistics.add(stillFrame(random, 5, 0), true);
    }
    EXPECT_FALSE(statistics.drag().has_value());
    EXPECT_FALSE(statistics.recentDrag().has_value());
}

// One rank is last in every frame, but by less than kTieMs. A slower core or a longer way is not a fault.
TEST(RankStatistics, TakeLessThanAMillisecondForATie) {
    RankStatistics statistics(4);
    for (int frame = 0; frame < 300; ++frame) {
        statistics.add(frameOf({1, 1.9, 1}), true);
    }
    EXPECT_EQ(statistics.ranks()[2].keptMs.count(), 0U);
    EXPECT_FALSE(statistics.drag().has_value());
    EXPECT_FALSE(statistics.recentDrag().has_value());
}

// Twelve ranks draw on two cores. In each frame some rank is last by much.
TEST(RankStatistics, AccuseNobodyWhomChanceMakesLast) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> any(5, 130);
        for (const std::size_t ranks : {2U, 12U}) {
            RankStatistics statistics(ranks + 1);
            for (int frame = 0; frame < 300; ++frame) {
                std::vector<double> ms(ranks);
                std::generate(ms.begin(), ms.end(), [&] { return any(random); });
                statistics.add(frameOf(ms), true);
            }
            EXPECT_FALSE(statistics.drag().has_value()) << ranks << " ranks, seed " << seed;
        }
    }
}

TEST(RankStatistics, DoNotChargeARankForTheMastersDisk) {
    RankStatistics statistics(3);
    for (int frame = 0; frame < 100; ++frame) {
        std::vector<Arrival> arrivals = frameOf({1, 4});
        arrivals[0].arrived = 40'000'000;
        statistics.add(arrivals, true);
    }
    ASSERT_TRUE(statistics.drag().has_value());
    EXPECT_EQ(statistics.drag()->rank, 0);
    EXPECT_NEAR(statistics.drag()->keptMs, 36, 0.01);
}

TEST(RankStatistics, HaveNobodyToCompareTheOnlyRankWith) {
    RankStatistics statistics(2);
    for (int frame = 0; frame < 100; ++frame) {
        statistics.add(frameOf({40}), true);
    }
    EXPECT_FALSE(statistics.drag().has_value());
}

TEST(RankStatistics, JudgeNobodyByAFewFrames) {
    RankStatistics statistics(3);
    for (int frame = 0; frame < 10; ++frame) {
        statistics.add(frameOf({1, 40}), true);
    }
    EXPECT_FALSE(statistics.drag().has_value());
}

TEST(RankStatistics, ForgetInTheRecentFramesWhatIsOver) {
    std::mt19937 random(7);
    RankStatistics statistics(kRanks + 1);
    for (int frame = 0; frame < 300; ++frame) {
        statistics.add(stillFrame(random, frame < 150 ? 3 : 0, 30), true);
    }
    EXPECT_FALSE(statistics.recentDrag().has_value());
    ASSERT_TRUE(statistics.drag().has_value());
    EXPECT_EQ(statistics.drag()->rank, 3);
    EXPECT_NEAR(statistics.drag()->share, 0.5, 1e-9);
}

TEST(RankStatistics, TellSwapTimesFromTheFirstOfTheirFrame) {
    RankStatistics statistics(4);
    std::vector<Arrival> arrivals = frameOf({1, 1, 1});
    statistics.add(arrivals, true);
    EXPECT_TRUE(statistics.lastSwapsUs().empty()) << "no rank has swapped yet";
    arrivals[1].lastSwap = 7'000'300'000;
    arrivals[2].lastSwap = 7'000'000'000;
    arrivals[3].lastSwap = 7'000'120'000;
    statistics.add(arrivals, true);
    EXPECT_EQ(statistics.lastSwapsUs(), (std::vector<std::uint32_t>{300, 0, 120}));
    statistics.add(arrivals, false);
    EXPECT_TRUE(statistics.lastSwapsUs().empty());
    EXPECT_EQ(statistics.ranks()[1].swapUs.count(), 1U);
    EXPECT_EQ(statistics.ranks()[1].swapUs.largest(), 300);
}

TEST(RankStatistics, CountTheFramesInWhichARankAgreed) {
    RankStatistics statistics(4);
    statistics.add(frameOf({1, 1, 1}), true);
    statistics.add(frameOf({1, 1, 1}), true);
    statistics.addOdd(std::vector{2});
    EXPECT_EQ(statistics.frames(), 2U);
    EXPECT_EQ(statistics.ranks()[1].agreed, 3U);
    EXPECT_EQ(statistics.ranks()[2].agreed, 2U);
    EXPECT_EQ(statistics.ranks()[2].differed, 1U);
}

TEST(RankStatistics, CountAHealedFrameOnce) {
    RankStatistics statistics(4);
    statistics.addHealed(std::vector{0, 2});
    statistics.add(frameOf({1, 1, 1}), true);
    statistics.add(frameOf({1, 1, 1}), true);
    EXPECT_EQ(statistics.frames(), 2U);
    for (const std::size_t rank : {0U, 2U}) {
        EXPECT_EQ(statistics.ranks()[rank].agreed, 1U);
        EXPECT_EQ(statistics.ranks()[rank].differed, 1U);
        EXPECT_EQ(statistics.ranks()[rank].healed, 1U);
    }
    EXPECT_EQ(statistics.ranks()[1].agreed, 2U);
    EXPECT_EQ(statistics.ranks()[1].healed, 0U);
}

}  // namespace
