// SPDX-License-Identifier: Apache-2.0
#include "bench/report/timing.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Timing, ASlowMeasurementIsRunFewerTimes) {
    EXPECT_EQ(bench::runsFor(4.99, 10), 10);
    EXPECT_EQ(bench::runsFor(5, 10), 3);
    EXPECT_EQ(bench::runsFor(59.9, 10), 3);
    EXPECT_EQ(bench::runsFor(60, 10), 1);
}

TEST(Timing, NoMeasurementIsRunMoreOftenThanAskedFor) {
    EXPECT_EQ(bench::runsFor(0.1, 1), 1);
    EXPECT_EQ(bench::runsFor(10, 2), 2);
}

TEST(Timing, SaysHowOftenAMeasurementIsRun) {
    EXPECT_EQ(bench::runsRule(10), "10 if the first takes less than 5 s, 3 if less than 60 s, else 1");
    EXPECT_EQ(bench::runsRule(2), "2 if the first takes less than 5 s, 2 if less than 60 s, else 1");
}

}  // namespace
