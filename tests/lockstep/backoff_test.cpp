// SPDX-License-Identifier: Apache-2.0
#include "lockstep/backoff.hpp"

#include <gtest/gtest.h>

namespace {

using lockstep::Backoff;

TEST(Backoff, OfAShortWaitIsNotSlept) {
    EXPECT_EQ(Backoff::sleepAfter(0), 0);
    EXPECT_EQ(Backoff::sleepAfter(20'000), 0);
}

TEST(Backoff, MakesNoWaitMuchLonger) {
    for (std::int64_t waited = 0; waited < 1'000'000'000; waited = waited * 5 / 4 + 1000) {
        EXPECT_LE(Backoff::sleepAfter(waited), waited / 8) << waited;
        EXPECT_LE(Backoff::sleepAfter(waited), 125'000) << waited;
    }
}

// With the pauses, a rank of a still wall looks some hundred times per frame and not a hundred thousand times.
TEST(Backoff, LooksSeldomInALongWait) {
    int looks = 0;
    for (std::int64_t waited = 60'000; waited < 33'000'000; waited += Backoff::sleepAfter(waited)) {
        ++looks;
    }
    EXPECT_LT(looks, 400);
}

}  // namespace
