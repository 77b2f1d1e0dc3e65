// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "haptic_bridge/hand/guard_counts.hpp"
#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Limit on how fast a force changes. A force may grow or turn by at most `most` per tick. It may fall at once, because
/// a hand that leaves the sand must not be held.
class Slew {
public:
    explicit Slew(double most /* [N/tick] */) : most_(most) {}

    [[nodiscard]] sand::force::Vec3 follow(sand::force::Vec3 wanted, std::uint32_t& acted) {
        // The part of the last force that remains along its own direction may fall freely. From there the change is
        // bounded.
        const double size = norm(last_);
        const double along = size > 0 ? std::clamp(dot(wanted, last_) / size, 0.0, size) : 0;
        const sand::force::Vec3 kept = size > 0 ? (along / size) * last_ : sand::force::Vec3{};
        const sand::force::Vec3 step = wanted - kept;
        const double length = norm(step);
        const bool tooFar = length > most_;
        acted |= tooFar ? bit(Guard::slew) : 0;
        last_ = tooFar ? kept + (most_ / length) * step : wanted;
        return last_;
    }
    /// Shortens the last force to `share` of it, 0 to 1.
    void shorten(double share) { last_ = share * last_; }
    [[nodiscard]] sand::force::Vec3 last() const { return last_; }
    void restart() { last_ = {}; }

private:
    double most_;
    sand::force::Vec3 last_;
};

}  // namespace haptic_bridge
