// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/pointer_arbiter.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using haptic_bridge::PointerReport;
using Hand = std::optional<std::size_t>;

PointerReport still() { return {}; }
PointerReport hovering() {
    PointerReport report;
    report.count = 1;
    return report;
}
PointerReport touching(std::uint32_t number = 1) {
    PointerReport report = hovering();
    report.touch = number;
    report.pressed = 1;
    return report;
}
/// Returns a touch that began and ended since the report before.
PointerReport tapping(std::uint32_t number) {
    PointerReport report = touching(number);
    report.samples[0].pressed = 1;
    report.pressed = 0;
    return report;
}

/// A master and three ranks.
class PointerArbiter : public testing::Test {
protected:
    Hand hand(const PointerReport& first, const PointerReport& second, const PointerReport& third) {
        return arbiter_.hand(std::array{PointerReport{}, first, second, third});
    }
    haptic_bridge::PointerArbiter arbiter_;
};

TEST_F(PointerArbiter, GivesTheHandToThePointerThatMoves) {
    EXPECT_EQ(hand(still(), still(), still()), std::nullopt);
    EXPECT_EQ(hand(still(), hovering(), still()), Hand(2));
    EXPECT_EQ(hand(still(), still(), still()), Hand(2)) << "it rests there";
    EXPECT_EQ(hand(hovering(), still(), still()), Hand(1));
}

TEST_F(PointerArbiter, TheFirstTouchHasTheHandUntilItReleases) {
    EXPECT_EQ(hand(still(), touching(), still()), Hand(2));
    EXPECT_EQ(hand(touching(), touching(), hovering()), Hand(2));
    EXPECT_EQ(hand(touching(), touching(), touching()), Hand(2));
    EXPECT_EQ(hand(touching(), hovering(), touching()), Hand(1)) << "it has touched longest of those that are left";
    EXPECT_EQ(hand(hovering(), hovering(), touching()), Hand(3));
    EXPECT_EQ(hand(hovering(), still(), still()), Hand(1));
}

TEST_F(PointerArbiter, ANewTouchOfTheSamePointerComesAfterThoseThatLast) {
    EXPECT_EQ(hand(touching(1), still(), still()), Hand(1));
    EXPECT_EQ(hand(touching(1), touching(1), still()), Hand(1));
    EXPECT_EQ(hand(touching(2), touching(1), still()), Hand(2)) << "it released between two frames";
    EXPECT_EQ(hand(touching(2), still(), still()), Hand(1));
}

TEST_F(PointerArbiter, ATapBetweenTwoFramesCounts) {
    EXPECT_EQ(hand(hovering(), tapping(1), still()), Hand(2));
    EXPECT_EQ(hand(hovering(), still(), still()), Hand(1)) << "it has ended";
}

TEST_F(PointerArbiter, OfTwoTouchesInOneFrameTheLowerRankIsFirst) {
    EXPECT_EQ(hand(still(), touching(), touching()), Hand(2));
    EXPECT_EQ(hand(still(), touching(), touching()), Hand(2));
}

}  // namespace
