// SPDX-License-Identifier: Apache-2.0
#include "lockstep/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

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

/// Returns the percentiles at the shares 0, 0.1, 0.2, … of these values.
std::vector<double> tenths(const std::vector<double>& values) {
    lockstep::Statistics figures;
    for (const double value : values) {
        figures.add(value);
    }
    std::vector<double> tenths;
    for (int tenth = 0; tenth <= 10; ++tenth) {
        tenths.push_back(figures.percentile(tenth / 10.0));
    }
    return tenths;
}

// The value with the index that is next to share * (n - 1); of two that are equally near, the higher one.
TEST(Statistics, OfFewValuesAreThoseNextToTheirShare) {
    EXPECT_EQ(tenths({7}), std::vector<double>(11, 7));
    EXPECT_EQ(tenths({2, 1}), (std::vector<double>{1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2}));
    EXPECT_EQ(tenths({3, 1, 4, 2}), (std::vector<double>{1, 1, 2, 2, 2, 3, 3, 3, 3, 4, 4}));
    lockstep::Statistics ten;
    for (int i = 1; i <= 10; ++i) {
        ten.add(i);
    }
    EXPECT_EQ(ten.percentile(0.99), 10) << "index 8.91";
    EXPECT_EQ(ten.percentile(0.94), 9) << "index 8.46";
}

// At most four values are kept. They are every second value at first, and every fourth from the ninth value on.
TEST(Statistics, AreThinnedEvenly) {
    lockstep::Statistics figures(4);
    const auto kept = [&figures](std::size_t count) {
        std::vector<double> values;
        for (std::size_t i = 0; i < count; ++i) {
            values.push_back(figures.percentile(static_cast<double>(i) / static_cast<double>(count - 1)));
        }
        return values;
    };
    for (int i = 0; i < 8; ++i) {
        figures.add(i);
    }
    EXPECT_EQ(kept(4), (std::vector<double>{0, 2, 4, 6}));
    figures.add(8);
    figures.add(9);
    EXPECT_EQ(kept(3), (std::vector<double>{0, 4, 8}));
    for (int i = 10; i < 1000; ++i) {
        figures.add(i);
    }
    EXPECT_EQ(kept(4), (std::vector<double>{0, 256, 512, 768}));
    EXPECT_EQ(figures.largest(), 999) << "of all values";
    EXPECT_DOUBLE_EQ(figures.mean(), 499.5) << "of all values";
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
