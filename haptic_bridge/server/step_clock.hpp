// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace haptic_bridge {

/// Says when steps are due: so many a second, softly locked to the wall's frames when both run at nearly one rate.
///
/// Two free clocks of 60.00 and 59.94 Hz drift past each other: every 17 s a frame would show two steps or none. While
/// the wall's rate is within 5 % of the nominal one, steps follow it, half a frame after the wall has swapped. Pure:
/// it knows only the times it is given [ns, one monotonic clock].
class StepClock {
public:
    explicit StepClock(int stepsPerSecond);

    /// The first step is due one period after `now`.
    void start(std::int64_t now);
    /// The wall swapped at `now`, `intervalNs` after the swap before.
    void frameShown(std::int64_t now, std::int64_t intervalNs);
    [[nodiscard]] std::int64_t due() const { return due_; }
    /// The step due was made, or withheld. A clock that is more than a quarter of a second behind starts afresh.
    void advance(std::int64_t now);
    [[nodiscard]] bool locked() const { return locked_; }
    [[nodiscard]] std::int64_t periodNs() const { return period_; }

private:
    std::int64_t period_;  // nominal
    std::int64_t due_ = 0;
    double frame_ = 0;  // smoothed frame interval
    std::int64_t lastFrame_ = 0;
    bool locked_ = false;
};

}  // namespace haptic_bridge
