// SPDX-License-Identifier: Apache-2.0
#include "master/measure/slowest_host.hpp"

#include <gtest/gtest.h>

namespace {

using haptic_bridge::FrameCost;
using lockstep::Arrival;
using lockstep::RankHost;

/// The coarse phase takes 100 ns longer than the movement.
Arrival arrival(std::int64_t dragged, std::int64_t swept, std::int64_t hashed, std::int64_t drawn) {
    Arrival rank;
    rank.dragged = dragged;
    rank.slid = dragged + 100;
    rank.swept = swept;
    rank.hashed = hashed;
    rank.drawn = drawn;
    return rank;
}

TEST(FrameCost, OfRanksThatShareAHostIsTheMedianOfEachTime) {
    const std::vector<RankHost> hosts(4, {.name = "a", .machine = "1"});
    EXPECT_EQ(master::costOf(
                  {arrival(10, 7, 90, 1), arrival(900, 5, 2, 3), arrival(12, 600, 1, 8), arrival(11, 6, 3, 2)}, hosts),
              (FrameCost{.sweepNs = 7, .dragNs = 12, .phaseNs = 112, .hashNs = 3, .drawNs = 8}))
        << "of two in the middle, the longer one; the drawing is that of the slowest rank";
}

TEST(FrameCost, IsThatOfTheSlowestHost) {
    const std::vector<RankHost> hosts{
        {.name = "a", .machine = "1"}, {.name = "b", .machine = "2"}, {.name = "c", .machine = "1"}};
    const std::vector<Arrival> ranks{arrival(1, 2, 3, 4), arrival(30, 20, 10, 0), arrival(5, 50, 6, 7)};
    EXPECT_EQ(master::costOf(ranks, hosts),
              (FrameCost{.sweepNs = 50, .dragNs = 30, .phaseNs = 130, .hashNs = 10, .drawNs = 7}));
}

TEST(FrameCost, OfOneRankOnEachHostIsTheLongest) {
    const std::vector<RankHost> hosts{
        {.name = "a", .machine = "1"}, {.name = "a", .machine = "2"}, {.name = "a", .machine = "3"}};
    const std::vector<Arrival> ranks{arrival(1, 2, 3, 4), arrival(9, 1, 2, 3), arrival(2, 8, 1, 2)};
    EXPECT_EQ(master::costOf(ranks, hosts),
              (FrameCost{.sweepNs = 8, .dragNs = 9, .phaseNs = 109, .hashNs = 3, .drawNs = 4}));
}

}  // namespace
