// SPDX-License-Identifier: Apache-2.0
#include "lockstep/host_memory.hpp"

#include <gtest/gtest.h>

namespace {

constexpr std::int64_t kGiB = std::int64_t{1} << 30;

TEST(HostMemory, WhatFitsIsNoMatter) {
    EXPECT_FALSE(lockstep::lackOfMemory({{"a", 8 * kGiB}, {"a", 8 * kGiB}}, 4 * kGiB));
    EXPECT_FALSE(lockstep::lackOfMemory({}, kGiB));
}

TEST(HostMemory, RanksOfOneHostShareWhatItHas) {
    const auto lack = lockstep::lackOfMemory({{"a", 8 * kGiB}, {"a", 8 * kGiB}, {"a", 8 * kGiB}}, 4 * kGiB);
    EXPECT_EQ(lack, "at least 12.0 GiB for the 3 ranks on a, where 8.0 GiB are free");
}

TEST(HostMemory, TheHostThatLacksMostIsNamed) {
    const auto lack = lockstep::lackOfMemory({{"a", 3 * kGiB}, {"b", kGiB}}, 4 * kGiB);
    EXPECT_EQ(lack, "at least 4.0 GiB for the one rank on b, where 1.0 GiB are free");
}

TEST(HostMemory, AllRanksButTheMasterDraw) {
    const std::vector<lockstep::RankHost> ranks{{"a", 8 * kGiB}, {"a", 8 * kGiB}, {"b", 8 * kGiB}};
    EXPECT_FALSE(lockstep::lackOfMemory(ranks, kGiB, 6 * kGiB));
    EXPECT_EQ(lockstep::lackOfMemory(ranks, kGiB, 8 * kGiB),
              "at least 10.0 GiB for the 2 ranks on a, where 8.0 GiB are free");
}

}  // namespace
