// SPDX-License-Identifier: Apache-2.0
#include "lockstep/watchdog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "lockstep/cluster.hpp"

namespace lockstep {
namespace {

constexpr double kFirstWord = 1;  // [s]
constexpr double kStartUpFirstWord = 10;
constexpr double kStartUpLimit = 120;
constexpr double kRankAfterMaster = 3;  // so much later a rank does what the master would have done

}  // namespace

Watchdog::Watchdog(std::function<std::string()> describe, double limitSeconds, Role role)
    : describe_(std::move(describe)), limit_(limitSeconds), role_(role), thread_([this] { look(); }) {}

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
    const double later = role_ == Role::master ? 0 : kRankAfterMaster;
    const bool speaks = role_ != Role::otherRank;
    while (!stop_.wait_for(lock, std::chrono::milliseconds(100), [this] { return stopping_; })) {
        const std::int64_t since = armedAt_;
        if (since == 0) {
            continue;
        }
        const double seconds = static_cast<double>(nowNs() - since) * 1e-9 - later;
        const double limit = startingUp_ ? std::max(limit_, kStartUpLimit) : limit_;
        if (seconds > limit) {
            if (speaks) {
                fmt::print(stderr, "sandwall: {} for {:.1f} s; the limit is {:.0f} s, ending the job\n", describe_(),
                           seconds + later, limit);
                std::fflush(stderr);
            }
            std::_Exit(1);
        }
        if (speaks && seconds > (startingUp_ ? kStartUpFirstWord : kFirstWord) && spokenOf != since) {
            spokenOf = since;
            fmt::print(stderr, "sandwall: {} for {:.1f} s\n", describe_(), seconds + later);
        }
    }
}

}  // namespace lockstep
