// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace haptic_bridge {

/// Guard against sand that gets no steps, whatever the cause: a pause, a full disk, a slow wall, a master that hangs.
/// The hand would press on a picture of sand that never gives way.
///
/// When the newest step is too old, the force fades to 0. It stays 0 until steps have come for kSteady, and then grows
/// in a ramp. Used by one thread.
class FrozenSand {
public:
    static constexpr double kOldest = 0.25;  // [s], age of the newest step that a wall with hiccups may reach
    static constexpr double kOldestSteps = 3;
    static constexpr double kFade = 0.1, kSteady = 1, kRamp = 0.5;  // [s]

    explicit FrozenSand(double stepSeconds) : oldest_(std::max(kOldest, kOldestSteps * stepSeconds)) {}

    /// Returns the share of the force at this tick, `span` [s] after the tick before. `age` [s] is that of the newest
    /// step. A `span` that is NaN counts as 0.
    [[nodiscard]] double next(double span, double age) {
        const double passed = span > 0 ? span : 0;  // a NaN would stay in every later share
        steady_ = age <= oldest_ ? steady_ + passed : 0;
        if (!(age <= oldest_)) {
            frozen_ = true;
        } else if (steady_ >= kSteady) {
            frozen_ = false;
        }
        share_ += frozen_ ? -passed / kFade : passed / kRamp;
        share_ = std::clamp(share_, 0.0, 1.0);
        return share_;
    }

private:
    double oldest_;      // [s]
    double steady_ = 0;  // [s], time for which steps have come
    double share_ = 1;
    bool frozen_ = false;
};

}  // namespace haptic_bridge
