// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace haptic_bridge {

/// Clock that decides when steps are due. It is softly locked to the wall's frames if both have nearly the same rate.
///
/// Two free clocks of 60.00 and 59.94 Hz drift past each other: every 17 s a frame would show two steps or none. While
/// the wall's rate is within 5 % of the nominal rate, steps follow it, half a frame after each swap. It reads no clock:
/// the caller passes the times [ns] of one monotonic clock.
class StepClock {
public:
    explicit StepClock(int stepsPerSecond);

    /// Starts the clock. The first step is due one period after `now`.
    void start(std::int64_t now);
    /// Takes a frame: the wall swapped at `now`, `intervalNs` after the previous swap.
    void frameShown(std::int64_t now, std::int64_t intervalNs);
    [[nodiscard]] std::int64_t due() const { return due_; }
    /// Moves on to the next step, because the due one was made or withheld. A clock that is more than a quarter of a
    /// second late starts again.
    void advance(std::int64_t now);
    [[nodiscard]] bool locked() const { return locked_; }
    [[nodiscard]] std::int64_t periodNs() const { return period_; }

private:
    std::int64_t period_;  // [ns], nominal
    std::int64_t due_ = 0;
    double frame_ = 0;  // [ns], smoothed frame interval
    std::int64_t lastFrame_ = 0;
    bool locked_ = false;
};

}  // namespace haptic_bridge
