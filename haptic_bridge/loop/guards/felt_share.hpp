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

    /// Returns the share at this tick, `span` [s] after the tick before. `wanted` is the share to reach, 0 to 1. The
    /// first tick begins with `wanted`, because the ramp of a start is longer.
    [[nodiscard]] double next(double span, double wanted) {
        if (!begun_) {
            begun_ = true;
            share_ = wanted;
        }
        const double most = std::clamp(span, 0.0, kFadeSeconds) / (wanted > share_ ? kRampSeconds : kFadeSeconds);
        share_ += std::clamp(wanted - share_, -most, most);
        return share_;
    }

private:
    bool begun_ = false;
    double share_ = 0;
};

}  // namespace haptic_bridge
