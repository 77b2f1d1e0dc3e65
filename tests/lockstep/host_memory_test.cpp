// SPDX-License-Identifier: Apache-2.0
#include "lockstep/host_memory.hpp"

#include <gtest/gtest.h>

namespace {

constexpr std::int64_t kGiB = std::int64_t{1} << 30;

std::vector<lockstep::RankNeed> all(std::size_t ranks, std::int64_t bytes) {
    return {ranks, lockstep::RankNeed{bytes}};
}

TEST(HostMemory, WhatFitsIsNoMatter) {
    EXPECT_FALSE(lockstep::lackOfMemory({{"a", 8 * kGiB}, {"a", 8 * kGiB}}, all(2, 4 * kGiB)));
    EXPECT_FALSE(lockstep::lackOfMemory({}, {}));
}

TEST(HostMemory, RanksOfOneHostShareWhatItHas) {
    const auto lack = lockstep::lackOfMemory({{"a", 8 * kGiB}, {"a", 8 * kGiB}, {"a", 8 * kGiB}}, all(3, 4 * kGiB));
    EXPECT_EQ(lack, "12.0 GiB for the 3 ranks on a, where 8.0 GiB are free");
}

TEST(HostMemory, TheHostThatLacksMostIsNamed) {
    const auto lack = lockstep::lackOfMemory({{"a", 3 * kGiB}, {"b", kGiB}}, all(2, 4 * kGiB));
    EXPECT_EQ(lack, "4.0 GiB for the one rank on b, where 1.0 GiB are free");
}

TEST(HostMemory, EachRankHasANeedOfItsOwn) {
    const std::vector<lockstep::RankHost> ranks{{"a", 8 * kGiB}, {"a", 8 * kGiB}, {"b", 8 * kGiB}};
    EXPECT_FALSE(lockstep::lackOfMemory(ranks, {{kGiB}, {7 * kGiB}, {8 * kGiB}}));
    EXPECT_EQ(lockstep::lackOfMemory(ranks, {{kGiB}, {9 * kGiB}, {8 * kGiB}}),
              "10.0 GiB for the 2 ranks on a, where 8.0 GiB are free");
}

TEST(HostMemory, CodeCountsOnceOnAHost) {
    const std::vector<lockstep::RankHost> ranks{{"a", 7 * kGiB}, {"a", 7 * kGiB}, {"a", 7 * kGiB}};
    EXPECT_FALSE(lockstep::lackOfMemory(ranks, {{3 * kGiB, kGiB}, {3 * kGiB, kGiB}, {3 * kGiB, kGiB}}));
    EXPECT_EQ(lockstep::lackOfMemory(ranks, {{3 * kGiB, kGiB}, {3 * kGiB, kGiB}, {4 * kGiB, kGiB}}),
              "8.0 GiB for the 3 ranks on a, where 7.0 GiB are free");
}

}  // namespace
