// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "haptic_bridge/loop/hand_channel.hpp"

namespace haptic_bridge {

/// The force thread. It runs a thousand ticks per second on the host's clock, and never waits for another thread.
///
/// It sleeps until absolute deadlines, with real-time priority if the host allows it. If the loop is late by one tick
/// or more, it skips the missed ticks. A burst of late ticks would feel the same place again and again.
///
/// When it ends, it pushes 0, whatever the reason. An exception of the device or of a tick ends it too; the channel
/// gets the exception.
class ForceLoop {
public:
    /// The loop also ends when `over` becomes true. `device` names the device in messages.
    ForceLoop(HapticTick& hand, HandChannel& channel, const std::string& device, const std::atomic<bool>& over);
    ~ForceLoop();
    ForceLoop(const ForceLoop&) = delete;
    ForceLoop& operator=(const ForceLoop&) = delete;

    /// Ends the loop, and waits until it has pushed 0.
    void stop();

    // These functions may be called by any thread.
    [[nodiscard]] const base::LiveHistogram& period() const { return period_; }
    [[nodiscard]] const base::LiveHistogram& computing() const { return computing_; }  // cost of a whole tick
    [[nodiscard]] std::uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }  // [tick]
    /// Returns the reason why the loop has no real-time priority; empty if it has.
    [[nodiscard]] const std::string& priorityRefused() const { return priorityRefused_; }
    /// Returns one line for the user: ticks, periods, computing times and missed deadlines so far.
    [[nodiscard]] std::string summary() const;

private:
    void run();

    HapticTick& hand_;
    HandChannel& channel_;
    const std::atomic<bool>& over_;
    base::LiveHistogram period_, computing_;
    std::atomic<std::uint64_t> missed_{0};
    std::string priorityRefused_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptic_bridge
