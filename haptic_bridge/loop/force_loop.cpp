// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/force_loop.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <time.h>

#include <algorithm>
#include <cstring>

#include "host/clock.hpp"

namespace haptic_bridge {
namespace {

constexpr std::int64_t kTickNs = 1'000'000;

void sleepUntil(std::int64_t whenNs) {
    const timespec when{whenNs / 1'000'000'000, whenNs % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) != 0) {
    }
}

/// Lets go of the hand at the end of a scope, also when an exception ends it.
class LetGo {
public:
    explicit LetGo(HapticTick& hand) : hand_(hand) {}
    ~LetGo() { hand_.letGo(); }
    LetGo(const LetGo&) = delete;
    LetGo& operator=(const LetGo&) = delete;

private:
    HapticTick& hand_;
};

}  // namespace

ForceLoop::ForceLoop(HapticTick& hand, HandChannel& channel, const std::string& device, const std::atomic<bool>& over)
    : hand_(hand), channel_(channel), over_(over) {
    thread_ = std::thread([this, name = "the force loop of device " + device] {
        channel_.failure.run(name, [this] {
            const LetGo atTheEnd(hand_);
            run();
        });
    });
    const sched_param priority{.sched_priority = 10};
    const int error = pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &priority);
    if (error != 0) {
        priorityRefused_ = std::strerror(error);
    }
}

ForceLoop::~ForceLoop() { stop(); }

void ForceLoop::stop() {
    stopping_ = true;
    if (thread_.joinable()) {
        thread_.join();
    }
}

void ForceLoop::run() {
    prctl(PR_SET_TIMERSLACK, 1UL);

    std::int64_t due = host::monotonicNs(), last = due;
    std::int64_t handTimeNs = 0;  // [ns], advances while a master is linked
    std::uint32_t sitting = 0;
    while (!stopping_ && !over_) {
        due += kTickNs;
        sleepUntil(due);
        const std::int64_t now = host::monotonicNs();
        const std::int64_t elapsed = now - last;
        last = now;
        period_.add(elapsed);
        const std::int64_t late = std::max<std::int64_t>(now - due, 0) / kTickNs;  // [tick]
        due += late * kTickNs;
        missed_.store(missed_.load(std::memory_order_relaxed) + static_cast<std::uint64_t>(late),
                      std::memory_order_relaxed);
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
        const HandSample sample = hand_.tick(handTime, now, channel_.surface.latest());
        channel_.keepTick();
        if (!channel_.samples.push(sample)) {
            channel_.overflow.fetch_add(1, std::memory_order_relaxed);
        }
        computing_.add(host::monotonicNs() - now);
    }
}

std::string ForceLoop::summary() const {
    const std::uint64_t ticks = period_.count(), due = ticks + missed();
    return fmt::format(
        "force loop: {} ticks, period p50 {:.0f} us, p99 {:.0f} us, max {:.0f} us; computing p50 {:.1f} us, p99 {:.1f} "
        "us; "
        "missed {} deadlines, {:.2g} per mille",
        ticks, period_.percentileNs(0.5) * 1e-3, period_.percentileNs(0.99) * 1e-3, period_.maxNs() * 1e-3,
        computing_.percentileNs(0.5) * 1e-3, computing_.percentileNs(0.99) * 1e-3, missed(),
        due == 0 ? 0.0 : 1000.0 * static_cast<double>(missed()) / static_cast<double>(due));
}

}  // namespace haptic_bridge
