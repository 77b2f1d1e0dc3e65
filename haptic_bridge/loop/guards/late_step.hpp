// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "haptic_bridge/loop/guards/force_limits.hpp"

namespace haptic_bridge {

/// Factor on the stiffness while a step comes late. A force that is held from step to step is held longer then, so that
/// the device bears less stiffness.
///
/// The factor falls at once, and rises again over kRise. It is always 1 for Between::local. Used by one thread.
class LateStep {
public:
    static constexpr double kRise = 0.5;  // [s]

    /// `limits` must outlive this object.
    explicit LateStep(const ForceLimits& limits) : limits_(&limits) {}

    /// Returns the factor at this tick, `span` [s] after the tick before. `age` [s] is that of the newest step.
    /// A `span` that is NaN counts as 0.
    [[nodiscard]] double next(double span, double age) {
        const double bearable = limits_->shareForStepOf(age);
        risen_ += span > 0 ? span : 0;
        const double rising = lowest_ + (1 - lowest_) * std::min(risen_ / kRise, 1.0);
        if (!(bearable > rising)) {
            lowest_ = bearable;
            risen_ = 0;
            return bearable;
        }
        return rising;
    }

private:
    const ForceLimits* limits_;
    double lowest_ = 1;  // factor from which it rises
    double risen_ = 0;   // [s], since then
};

}  // namespace haptic_bridge
