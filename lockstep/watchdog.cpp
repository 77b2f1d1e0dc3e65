// SPDX-License-Identifier: Apache-2.0
#include "lockstep/watchdog.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "lockstep/cluster.hpp"

namespace lockstep {

Watchdog::Watchdog(std::function<std::string()> describe, double limitSeconds, bool speaks)
    : describe_(std::move(describe)), limit_(limitSeconds), speaks_(speaks), thread_([this] { look(); }) {}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    stop_.notify_all();
    thread_.join();
}

void Watchdog::arm() { armedAt_ = nowNs(); }
void Watchdog::disarm() { armedAt_ = 0; }

void Watchdog::look() {
    std::unique_lock lock(mutex_);
    std::int64_t spokenOf = 0;  // the wait that was already mentioned
    while (!stop_.wait_for(lock, std::chrono::milliseconds(100), [this] { return stopping_; })) {
        const std::int64_t since = armedAt_;
        if (since == 0) {
            continue;
        }
        const double seconds = static_cast<double>(nowNs() - since) * 1e-9;
        if (seconds > limit_) {
            fmt::print(stderr, "sandwall: {} for {:.1f} s; the limit is {:.0f} s, ending the job\n", describe_(),
                       seconds, limit_.load());
            std::fflush(stderr);
            std::_Exit(1);
        }
        if (speaks_ && seconds > kFirstWord && spokenOf != since) {
            spokenOf = since;
            fmt::print(stderr, "sandwall: {} for {:.1f} s\n", describe_(), seconds);
        }
    }
}

}  // namespace lockstep
