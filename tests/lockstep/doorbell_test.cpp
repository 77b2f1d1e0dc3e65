// SPDX-License-Identifier: Apache-2.0
#include "lockstep/doorbell.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <new>
#include <thread>

#include "lockstep/backoff.hpp"

namespace {

using lockstep::Backoff;
using lockstep::Doorbell;

constexpr std::int64_t kMoment = 20'000'000;    // [ns]
constexpr std::int64_t kLong = 60'000'000'000;  // [ns]; a test that sleeps this long has failed

TEST(Doorbell, SleepsNoLongerThanItsLimit) {
    std::atomic<std::uint32_t> rings = 0;
    EXPECT_FALSE(Doorbell(rings).sleep(0, kMoment));
}

// A thread that reads the number, looks for a message and then sleeps misses no ring.
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
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // until it sleeps; an earlier ring also wakes it
    bell.ring();
    int status = -1;
    ASSERT_EQ(waitpid(sleeper, &status, 0), sleeper);
    EXPECT_EQ(status, 0);
    munmap(shared, 4096);
}

// Uses a clock of the test, so that the pauses do not depend on how busy the machine is.
TEST(Backoff, SleepsUntilTheBellRings) {
    using Kind = Backoff::Rest::Kind;
    std::atomic<std::uint32_t> rings = 0;
    Backoff backoff{Doorbell(rings)};
    EXPECT_EQ(backoff.nextRest(1000).kind, Kind::yield) << "a short wait";
    const Backoff::Rest later = backoff.nextRest(1000 + kMoment);
    EXPECT_EQ(later.kind, Kind::sleepUntilRung);
    EXPECT_EQ(later.longest, 5'000'000) << "in case a message comes without a ring";
    Backoff asking;
    (void)asking.nextRest(1000);
    EXPECT_EQ(asking.nextRest(1000 + kMoment), (Backoff::Rest{Kind::sleep, 125'000})) << "without a bell";
}

// The ring for a long message comes before the message is there. The wait then polls and does not sleep until a second
// ring.
TEST(Backoff, AsksForAMessageThatHasRungAndIsNotThere) {
    using Kind = Backoff::Rest::Kind;
    std::atomic<std::uint32_t> rings = 0;
    const Doorbell bell(rings);
    Backoff backoff{bell};
    (void)backoff.nextRest(0);
    bell.ring();
    backoff.look();
    EXPECT_EQ(backoff.nextRest(kMoment), (Backoff::Rest{Kind::sleep, 125'000}));
    backoff.look();
    EXPECT_EQ(backoff.nextRest(2 * kMoment).kind, Kind::sleep) << "the message is not there yet";
    backoff.found();
    EXPECT_EQ(backoff.nextRest(3 * kMoment).kind, Kind::sleepUntilRung) << "more messages are awaited";
}

// If the bell has rung since the last look, rest() must not sleep at all.
TEST(Backoff, ReturnsAtOnceWhenTheBellRangBeforeItSlept) {
    std::atomic<std::uint32_t> rings = 0;
    const Doorbell bell(rings);
    Backoff backoff{bell};
    backoff.look();
    bell.ring();
    EXPECT_TRUE(bell.sleep(0, kLong)) << "the number differs from 0";
    backoff.look();
    EXPECT_NE(backoff.nextRest(kLong).kind, Backoff::Rest::Kind::sleepUntilRung);
}

}  // namespace
