// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "haptic_bridge/loop/hand_channel.hpp"

namespace haptic_bridge {

/// The force thread: ticks the hand a thousand times a second on the host's clock, and waits for nobody.
///
/// It sleeps until absolute deadlines, before other threads where the host allows it. A deadline that is missed by a
/// whole tick or more is skipped: a burst of late ticks would feel the same place again and again.
class ForceLoop {
public:
    ForceLoop(HapticTick& hand, HandChannel& channel);
    ~ForceLoop();
    ForceLoop(const ForceLoop&) = delete;
    ForceLoop& operator=(const ForceLoop&) = delete;

    // Any thread:
    [[nodiscard]] const base::LiveHistogram& period() const { return period_; }
    [[nodiscard]] const base::LiveHistogram& computing() const { return computing_; }               // of a whole tick
    [[nodiscard]] std::uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }  // [tick]
    /// Why the loop has no real-time priority; empty where it has.
    [[nodiscard]] const std::string& priorityRefused() const { return priorityRefused_; }
    /// What the loop did so far, in one line.
    [[nodiscard]] std::string summary() const;

private:
    void run();

    HapticTick& hand_;
    HandChannel& channel_;
    base::LiveHistogram period_, computing_;
    std::atomic<std::uint64_t> missed_{0};
    std::string priorityRefused_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptic_bridge
