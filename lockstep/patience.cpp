// SPDX-License-Identifier: Apache-2.0
#include "lockstep/patience.hpp"

#include <sched.h>
#include <sys/prctl.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "lockstep/cluster.hpp"

namespace lockstep {
namespace {

constexpr std::int64_t kYielding = 50'000;  // [ns]: shorter than a sleep and the waking from it
constexpr std::int64_t kLongest = 250'000;  // [ns]
constexpr std::int64_t kShare = 8;          // of a wait, the sleep that may follow: one eighth

}  // namespace

std::int64_t Patience::sleepAfter(std::int64_t waited) {
    return waited < kYielding ? 0 : std::min(waited / kShare, kLongest);
}

void Patience::rest() {
    const std::int64_t now = nowNs();
    since_ = since_ == 0 ? now : since_;
    if (const std::int64_t pause = sleepAfter(now - since_); pause > 0) {
        std::this_thread::sleep_for(std::chrono::nanoseconds(pause));
    } else {
        sched_yield();  // whoever draws on this core goes first
    }
}

void sleepPunctually() {
    constexpr unsigned long kSlack = 1000;  // [ns]
    prctl(PR_SET_TIMERSLACK, kSlack);
}

}  // namespace lockstep
