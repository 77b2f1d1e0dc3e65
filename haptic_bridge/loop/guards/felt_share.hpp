// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace haptic_bridge {

/// Share of each force that reaches the hand: the operator's share, and 0 while the clutch is held. It changes in a
/// ramp. Used by one thread.
class FeltShare {
public:
    static constexpr double kRampSeconds = 0.5;   // [s], from no force to the full force
    static constexpr double kFadeSeconds = 0.05;  // [s], from the full force to no force

    /// Returns the share at this tick, `span` [s] after the tick before. `wanted` is the share to reach, at most 1. The
    /// first tick begins with it, because the ramp of a start is longer. NaN counts as 0, for both numbers.
    [[nodiscard]] double next(double span, double wanted) {
        const double aim = wanted > 0 ? std::min(wanted, 1.0) : 0, passed = span > 0 ? std::min(span, kFadeSeconds) : 0;
        if (!begun_) {
            begun_ = true;
            share_ = aim;
        }
        const double most = passed / (aim > share_ ? kRampSeconds : kFadeSeconds);
        share_ += std::clamp(aim - share_, -most, most);
        return share_;
    }

private:
    bool begun_ = false;
    double share_ = 0;
};

}  // namespace haptic_bridge
