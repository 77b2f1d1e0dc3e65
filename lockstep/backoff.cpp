// SPDX-License-Identifier: Apache-2.0
#include "lockstep/backoff.hpp"

#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "host/clock.hpp"
#include "lockstep/cluster.hpp"

namespace lockstep {
namespace {

constexpr std::int64_t kYielding = 50'000;   // [ns], shorter than a sleep with its wake-up
constexpr std::int64_t kLongest = 125'000;   // [ns]
constexpr std::int64_t kShare = 8;           // a sleep lasts at most 1/8 of the wait so far
constexpr std::int64_t kOnBell = 5'000'000;  // [ns], limit in case a sender does not ring

/// The kernel's struct sched_attr, which the C library of Debian 12 does not declare.
struct SliceOfTime {
    std::uint32_t size = sizeof(SliceOfTime);
    std::uint32_t policy = SCHED_OTHER;
    std::uint64_t flags = 0;
    std::int32_t nice = 0;
    std::uint32_t priority = 0;
    std::uint64_t runtime = 0;  // [ns]
    std::uint64_t deadline = 0, period = 0;
};

}  // namespace

std::int64_t Backoff::sleepAfter(std::int64_t waited) {
    return waited < kYielding ? 0 : std::min(waited / kShare, kLongest);
}

Backoff::Backoff(const std::optional<Doorbell>& bell) : bell_(bell), heard_(bell ? bell->rings() : 0) {}

void Backoff::look() {
    if (bell_) {
        const std::uint32_t rings = bell_->rings();
        rang_ = rang_ || rings != heard_;
        heard_ = rings;
    }
}

void Backoff::found() { rang_ = false; }

Backoff::Rest Backoff::nextRest(std::int64_t now) {
    since_ = since_.value_or(now);
    const std::int64_t waited = now - *since_;
    if (bell_ && !rang_ && waited >= kYielding) {
        return {Rest::Kind::sleepUntilRung, kOnBell};
    }
    const std::int64_t pause = sleepAfter(waited);
    return {pause > 0 ? Rest::Kind::sleep : Rest::Kind::yield, pause};
}

void Backoff::rest() {
    const Rest next = nextRest(host::monotonicNs());
    switch (next.kind) {
        case Rest::Kind::yield:
            sched_yield();  // lets a process that draws on this core run first
            break;
        case Rest::Kind::sleep:
            std::this_thread::sleep_for(std::chrono::nanoseconds(next.longest));
            break;
        case Rest::Kind::sleepUntilRung:
            rang_ = bell_->sleep(heard_, next.longest);
            break;
    }
}

void wakePunctually() {
    constexpr unsigned long kSlack = 1000;  // [ns]
    prctl(PR_SET_TIMERSLACK, kSlack);
    if (sched_getscheduler(0) != SCHED_OTHER) {
        return;  // the user has chosen another scheduling policy
    }
    // Since Linux 6.12, a waking thread with a shorter slice runs before threads with longer slices. Older kernels
    // ignore the slice. This was measured with twelve ranks beside compilers that kept two cores busy. The p50 of the
    // swap skew is 170 us with the short slice and 3200 us without it.
    SliceOfTime slice;
    slice.nice = getpriority(PRIO_PROCESS, 0);
    slice.runtime = 100'000;
    syscall(SYS_sched_setattr, 0, &slice, 0);
}

}  // namespace lockstep
