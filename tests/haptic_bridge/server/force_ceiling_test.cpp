// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/force_ceiling.hpp"

#include <gtest/gtest.h>

namespace {

using haptic_bridge::feltShare;

TEST(FeltShare, IsNothingWithoutAMaster) {
    for (const bool untilOperator : {false, true}) {
        EXPECT_EQ(feltShare({1, untilOperator}, std::nullopt), 0);
        EXPECT_EQ(feltShare({0, untilOperator}, std::nullopt), 0);
    }
}

TEST(FeltShare, OfASessionWithoutAnOperatorsWordStaysUnderTheServersOptions) {
    for (const bool untilOperator : {false, true}) {
        EXPECT_EQ(feltShare({0, untilOperator}, {{1, false}}), 0);
        EXPECT_EQ(feltShare({0.3, untilOperator}, {{1, false}}), 0.3);
        EXPECT_EQ(feltShare({1, untilOperator}, {{1, false}}), 1);
    }
}

TEST(FeltShare, OfAServerThatAPersonHasStartedIsLiftedByNoMessage) {
    EXPECT_EQ(feltShare({0, false}, {{1, true}}), 0) << "--force off, then ctl force on";
    EXPECT_EQ(feltShare({0.3, false}, {{0.8, true}}), 0.3);
    EXPECT_EQ(feltShare({0.3, false}, {{0.2, true}}), 0.2) << "an operator can lower it";
    EXPECT_EQ(haptic_bridge::OwnForce({0.3, false}).ceiling(), 0.3);
}

TEST(FeltShare, OfTheSessionsOwnServerIsWhatAnOperatorHasSet) {
    EXPECT_EQ(feltShare({0, true}, {{1, true}}), 1) << "run --force off, then ctl force on";
    EXPECT_EQ(feltShare({0.3, true}, {{0.8, true}}), 0.8);
    EXPECT_EQ(feltShare({1, true}, {{0, true}}), 0);
    EXPECT_EQ(haptic_bridge::OwnForce({0.3, true}).ceiling(), 1);
}

}  // namespace
