// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/outbox.hpp"

#include <gtest/gtest.h>

#include "haptic_bridge/link/rate_limit.hpp"

namespace {

using namespace haptic_bridge;

TEST(Outbox, HoldsOrdinaryMessagesUpToItsMostAndOneLongOne) {
    Outbox outbox(10);
    EXPECT_TRUE(outbox.push(base::Bytes(6, 1), false));
    EXPECT_TRUE(outbox.push(base::Bytes(100, 2), true)) << "a long message does not count";
    EXPECT_FALSE(outbox.push(base::Bytes(100, 3), true)) << "a second long message is refused";
    EXPECT_TRUE(outbox.push(base::Bytes(4, 4), false));
    EXPECT_FALSE(outbox.push(base::Bytes(1, 5), false));
    EXPECT_EQ(outbox.size(), 3U) << "refused messages are not kept";
    outbox.pop();
    EXPECT_EQ(outbox.front(), base::Bytes(100, 2)) << "the oldest first";
    EXPECT_TRUE(outbox.push(base::Bytes(6, 6), false)) << "a sent message makes room";
    outbox.pop();
    EXPECT_TRUE(outbox.push(base::Bytes(100, 7), true));
    outbox.setMost(3);
    EXPECT_FALSE(outbox.push(base::Bytes(1, 8), false));
}

TEST(RateLimit, AllowsABurstAndThenItsRate) {
    std::int64_t now = 5'000'000'000;
    int looks = 0;
    const auto clock = [&] { return ++looks, now; };
    RateLimit limit(50, now);
    for (int i = 0; i < 50; ++i) {
        ASSERT_TRUE(limit.allows(clock));
        limit.use(1);
    }
    EXPECT_EQ(looks, 0) << "no clock is read while messages are left";
    EXPECT_FALSE(limit.allows(clock));
    now += 19'000'000;
    EXPECT_FALSE(limit.allows(clock)) << "0.95 of a message";
    now += 2'000'000;
    EXPECT_TRUE(limit.allows(clock));
    limit.use(1);
    now += 3'600'000'000'000;
    EXPECT_TRUE(limit.allows(clock));
    limit.use(50);
    EXPECT_FALSE(limit.allows(clock)) << "an hour of silence saves up one burst";
    limit.setRate(1);
    EXPECT_TRUE(limit.allows(clock));
}

}  // namespace
