// SPDX-License-Identifier: Apache-2.0
#include "lockstep/doorbell.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <new>
#include <thread>

#include "lockstep/patience.hpp"

namespace {

using lockstep::Doorbell;
using lockstep::Patience;

constexpr std::int64_t kMoment = 20'000'000;    // [ns]
constexpr std::int64_t kLong = 60'000'000'000;  // [ns]: a test that sleeps through has failed

TEST(Doorbell, SleepsNoLongerThanItsLimit) {
    std::atomic<std::uint32_t> rings = 0;
    EXPECT_FALSE(Doorbell(rings).sleep(0, kMoment));
}

// Who looks for a message between reading the number and sleeping misses no ring.
TEST(Doorbell, DoesNotSleepWhenItHasRungMeanwhile) {
    std::atomic<std::uint32_t> rings = 0;
    const Doorbell bell(rings);
    const std::uint32_t heard = bell.rings();
    bell.ring();
    EXPECT_TRUE(bell.sleep(heard, kLong));
}

TEST(Doorbell, WakesAnotherProcess) {
    void* const shared = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(shared, MAP_FAILED);
    const Doorbell bell(*new (shared) std::atomic<std::uint32_t>(0));
    const pid_t sleeper = fork();
    ASSERT_GE(sleeper, 0);
    if (sleeper == 0) {
        _exit(bell.sleep(0, kLong) ? 0 : 1);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // until it sleeps; if it does not yet, it need not
    bell.ring();
    int status = -1;
    ASSERT_EQ(waitpid(sleeper, &status, 0), sleeper);
    EXPECT_EQ(status, 0);
    munmap(shared, 4096);
}

/// How often a wait looks, its first 10 ms apart, until somebody rings and the message is there so much later.
int looksUntilThere(Patience& patience, const Doorbell& bell, std::chrono::milliseconds later) {
    std::atomic<bool> there = false;
    std::thread sender([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        bell.ring();
        std::this_thread::sleep_for(later);
        there = true;
    });
    int looks = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (patience.look(); !there; patience.look()) {
        looks += std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(10) ? 1 : 0;
        patience.rest();
    }
    sender.join();
    return looks;
}

TEST(Patience, SleepsThroughAWaitThatARingEnds) {
    std::atomic<std::uint32_t> rings = 0;
    Patience asking;
    const int asked = looksUntilThere(asking, Doorbell(rings), {});
    Patience sleeping{Doorbell(rings)};
    const int slept = looksUntilThere(sleeping, Doorbell(rings), {});
    EXPECT_LT(slept, asked / 2) << asked;  // its looks are some twenty, against some hundred
}

// A long message is announced before it is there: then it asks, and does not wait for a ring that has been.
TEST(Patience, AsksForWhatHasRungAndIsNotThere) {
    constexpr std::chrono::milliseconds kLater{100};  // as long as it takes until the ring
    std::atomic<std::uint32_t> rings = 0;
    Patience asking;
    const int asked = looksUntilThere(asking, Doorbell(rings), kLater);
    Patience patience{Doorbell(rings)};
    EXPECT_GT(looksUntilThere(patience, Doorbell(rings), kLater), asked / 4) << "half of it, and some";
}

}  // namespace
