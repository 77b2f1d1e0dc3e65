// SPDX-License-Identifier: Apache-2.0
#include "lockstep/watchdog.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "base/input_error.hpp"
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

TEST(Watchdog, RefusesAStartTimeoutThatIsNoNumberOfSecondsInItsRange) {
    const auto refused = [](const char* value) -> std::string {
        setenv("SANDWALL_START_TIMEOUT", value, 1);
        try {
            lockstep::requireStartUpLimit();
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "";
    };
    for (const char* good : {"", "1", "20.5", "3600", "3e2"}) {
        EXPECT_EQ(refused(good), "");
    }
    for (const char* bad : {"abc", "0.9", "3601", "-5", "nan", "inf", "20s", " 20"}) {
        EXPECT_EQ(refused(bad), std::string("SANDWALL_START_TIMEOUT: must be a number from 1 to 3600 [s], got '") +
                                    bad + "'; unset it for 120 s");
    }
    unsetenv("SANDWALL_START_TIMEOUT");
    EXPECT_NO_THROW(lockstep::requireStartUpLimit());
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
