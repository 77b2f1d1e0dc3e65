// SPDX-License-Identifier: Apache-2.0
#include "lockstep/watchdog.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/support/blocked_child.hpp"

namespace {

using lockstep::Wait;
using lockstep::Watchdog;

TEST(Watchdog, HasARolePerRank) {
    EXPECT_EQ(Watchdog::roleOf(0), Watchdog::Role::master);
    EXPECT_EQ(Watchdog::roleOf(1), Watchdog::Role::firstRank);
    EXPECT_EQ(Watchdog::roleOf(2), Watchdog::Role::otherRank);
    EXPECT_EQ(Watchdog::roleOf(12), Watchdog::Role::otherRank);
}

// Each description takes place after the limit, and another wait begins during it. The job must not end.
TEST(Watchdog, EndsNoJobForAWaitThatHasEndedMeanwhile) {
    EXPECT_TRUE(support::endsByItself([] {
        std::atomic<int> described{0};
        Watchdog* watched = nullptr;
        Watchdog watchdog(
            [&] {
                ++described;
                watched->arm();
                return Wait();
            },
            0.2, Watchdog::Role::master);
        watched = &watchdog;
        watchdog.startUpIsOver();
        watchdog.arm();
        while (described < 3) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        watchdog.disarm();
    }));
}

}  // namespace
