// SPDX-License-Identifier: Apache-2.0
#include "lockstep/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

TEST(Statistics, OfNothingAreZero) {
    const lockstep::Statistics none;
    EXPECT_EQ(none.percentile(0.5), 0);
    EXPECT_EQ(none.deviation(), 0);
}

TEST(Statistics, OfTheFirstThousandNumbers) {
    lockstep::Statistics figures;
    for (int i = 1; i <= 1000; ++i) {
        figures.add(i);
    }
    EXPECT_DOUBLE_EQ(figures.mean(), 500.5);
    EXPECT_NEAR(figures.deviation(), std::sqrt(1000.0 * 1001 / 12), 1e-9);
    EXPECT_NEAR(figures.percentile(0.5), 500, 1);
    EXPECT_NEAR(figures.percentile(0.99), 990, 1);
    EXPECT_EQ(figures.largest(), 1000);
}

TEST(Statistics, LongSessionsKeepTheirPercentilesInBoundedMemory) {
    lockstep::Statistics figures;
    std::mt19937 random(59);
    for (int i = 0; i < 1000000; ++i) {
        figures.add(static_cast<double>(random() % 1000));
    }
    EXPECT_NEAR(figures.percentile(0.5), 500, 5);
    EXPECT_NEAR(figures.percentile(0.99), 990, 5);
    EXPECT_EQ(figures.count(), 1000000U);
}

}  // namespace
