// SPDX-License-Identifier: Apache-2.0
#include "base/live_histogram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace {

TEST(LiveHistogram, EveryDurationIsInABucketThatBeginsAtMostAPercentBelow) {
    base::LiveHistogram histogram;
    const std::vector<std::int64_t> durations{0, 1, 127, 128, 255, 256, 257, 999'999, 1'000'000, 5'000'000'000};
    for (const std::int64_t duration : durations) {
        histogram.add(duration);
    }
    std::size_t i = 0;
    histogram.eachBucket([&](double lowest, std::uint64_t count) {
        for (; count > 0; --count, ++i) {
            ASSERT_LT(i, durations.size());
            const auto duration = static_cast<double>(durations[i]);
            EXPECT_LE(lowest, duration);
            EXPECT_GE(lowest, duration * (1 - 1.0 / 128));
        }
    });
    EXPECT_EQ(i, durations.size());
}

// Durations below 256 ns have buckets of their own.
TEST(LiveHistogram, OfFewDurationsGivesTheOneThatTheShareReaches) {
    base::LiveHistogram histogram;
    for (const std::int64_t duration : {30, 10, 20}) {
        histogram.add(duration);
    }
    for (const auto& [share, duration] :
         {std::pair{0.01, 10}, {0.33, 10}, {0.34, 20}, {0.5, 20}, {0.66, 20}, {0.67, 30}, {0.99, 30}, {1.0, 30}}) {
        EXPECT_EQ(histogram.percentileNs(share), duration) << share;
    }
}

TEST(LiveHistogram, PercentilesAreWithinAPercent) {
    base::LiveHistogram histogram;
    EXPECT_EQ(histogram.percentileNs(0.5), 0);
    for (int i = 1; i <= 100'000; ++i) {
        histogram.add(i * 10);
    }
    EXPECT_NEAR(histogram.percentileNs(0.50), 500'000, 5'000);
    EXPECT_NEAR(histogram.percentileNs(0.99), 990'000, 9'900);
    EXPECT_EQ(histogram.maxNs(), 1'000'000);
    EXPECT_NEAR(histogram.meanNs(), 500'005, 1);
    EXPECT_NEAR(histogram.stddevNs(), 1'000'000 / std::sqrt(12.0), 10);
}

}  // namespace
