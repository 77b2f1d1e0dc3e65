// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/force_ceiling.hpp"

#include <gtest/gtest.h>

namespace {

using haptic_bridge::feltShare;

TEST(FeltShare, IsNothingWithoutAMaster) {
    EXPECT_EQ(feltShare(1, std::nullopt), 0);
    EXPECT_EQ(feltShare(0, std::nullopt), 0);
}

TEST(FeltShare, OfASessionWithoutAnOperatorsWordStaysUnderTheServersCeiling) {
    EXPECT_EQ(feltShare(0, {{1, false}}), 0);
    EXPECT_EQ(feltShare(0.3, {{1, false}}), 0.3);
    EXPECT_EQ(feltShare(1, {{1, false}}), 1);
}

TEST(FeltShare, IsWhatAnOperatorOfTheSessionHasSet) {
    EXPECT_EQ(feltShare(0, {{1, true}}), 1) << "--force off, then ctl force on";
    EXPECT_EQ(feltShare(0.3, {{0.8, true}}), 0.8);
    EXPECT_EQ(feltShare(1, {{0, true}}), 0);
}

}  // namespace
