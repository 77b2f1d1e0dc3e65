// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>

#include "haptic_bridge/sequencer.hpp"

namespace haptic_bridge {

/// The force thread: ticks the hand a thousand times a second on the host's clock, and waits for nobody.
class ForceLoop {
public:
    ForceLoop(Hand& hand, HandChannel& channel);
    ~ForceLoop();
    ForceLoop(const ForceLoop&) = delete;
    ForceLoop& operator=(const ForceLoop&) = delete;

    [[nodiscard]] const LiveHistogram& period() const { return period_; }

private:
    void run();

    Hand& hand_;
    HandChannel& channel_;
    LiveHistogram period_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptic_bridge
