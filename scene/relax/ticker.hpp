// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

namespace scene::relax {

using Clock = std::chrono::steady_clock;

inline constexpr auto kReportEvery = std::chrono::seconds(1);

inline double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Prints on stderr every second that work continues. It is for work that has no sweeps to count before its end.
class Ticker {
public:
    explicit Ticker(std::string what)
        : what_(std::move(what)), thread_([this](const std::stop_token& stop) { tick(stop); }) {}

private:
    void tick(const std::stop_token& stop) {
        const Clock::time_point start = Clock::now();
        std::unique_lock lock(mutex_);
        while (!wake_.wait_for(lock, stop, kReportEvery, [] { return false; }) && !stop.stop_requested()) {
            fmt::print(stderr, "sandwall-relax: {:.0f} s: {}\n", secondsSince(start), what_);
        }
    }

    std::string what_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread thread_;  // last member, because it uses the others
};

}  // namespace scene::relax
