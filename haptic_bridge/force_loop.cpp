// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/force_loop.hpp"

#include <pthread.h>
#include <sys/prctl.h>
#include <time.h>

#include "haptic_bridge/monotonic.hpp"

namespace haptic_bridge {
namespace {

constexpr std::int64_t kTickNs = 1'000'000;
constexpr std::int64_t kGiveUpNs = 100 * kTickNs;  // farther behind than this, missed ticks are not caught up

void sleepUntil(std::int64_t whenNs) {
    const timespec when{whenNs / 1'000'000'000, whenNs % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) != 0) {
    }
}

}  // namespace

ForceLoop::ForceLoop(Hand& hand, HandChannel& channel) : hand_(hand), channel_(channel) {
    thread_ = std::thread([this] { run(); });
}

ForceLoop::~ForceLoop() {
    stopping_ = true;
    thread_.join();
}

void ForceLoop::run() {
    // Where the host allows it, before other threads; where it does not, as good as can be.
    const sched_param priority{.sched_priority = 10};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
    prctl(PR_SET_TIMERSLACK, 1UL);

    std::int64_t due = monotonicNs(), last = due;
    std::int64_t handTimeNs = 0;  // runs while a master is linked
    std::uint32_t sitting = 0;
    while (!stopping_) {
        due += kTickNs;
        sleepUntil(due);
        const std::int64_t now = monotonicNs();
        const std::int64_t elapsed = now - last;
        last = now;
        period_.add(elapsed);
        due = now - due > kGiveUpNs ? now : due;
        const bool moving = channel_.moving.load(std::memory_order_acquire);
        handTimeNs += moving ? elapsed : 0;
        const double handTime = static_cast<double>(handTimeNs) * 1e-9;
        if (!moving) {
            hand_.rest(handTime);
            continue;
        }
        if (const std::uint32_t latest = channel_.sitting; latest != sitting) {
            sitting = latest;
            channel_.beginSitting(hand_);
        }
        const Surface& surface = channel_.surface.latest();
        const HandSample sample = hand_.tick(handTime, now, surface);
        channel_.keep(now, surface);
        if (!channel_.samples.push(sample)) {
            channel_.overflow.fetch_add(1, std::memory_order_relaxed);
        }
    }
}

}  // namespace haptic_bridge
