// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Cross-over of the law's force after an edit. An edit replaces the sand or the tool under a hand that holds against
/// the old force. So the force moves within kSeconds from the old one to what the law asks for now.
///
/// A hand that moves out must not be pushed by sand that it has left. The sand before the edit was at most as stiff as
/// the device may get. So the rest of the old force falls by that stiffness times the way of the hand. Only a way that
/// leads deeper along the force does not count. A tool that is lifted is free at once.
///
/// Used by one thread.
class CrossOver {
public:
    static constexpr double kSeconds = 0.05;

    explicit CrossOver(const ForceLimits& limits) : stiffness_(limits.stiffness), maxForce_(limits.maxForce) {}

    struct Tick {
        double time = 0;            // [s]
        bool edited = false;        // the first tick that feels a step with an edit
        bool engaged = true;        // the tool may touch the sand
        double passed = 1;          // part of the last force that the gate has passed, beside ramps and shares
        sand::force::Vec3 place{};  // [m]
    };
    /// Returns the force of this tick [N]: `wanted`, or a force between the last one and `wanted`. The device's
    /// greatest force bounds both of them during a cross-over.
    [[nodiscard]] sand::force::Vec3 next(const Tick& now, sand::force::Vec3 wanted) {
        const Tick before = std::exchange(last_, now);
        if (now.edited) {
            until_ = before.time + kSeconds;
            force_ = now.passed * sand::force::shortened(force_, maxForce_);
        }
        if (!now.engaged || !(norm(force_) > 0)) {
            stop();
        }
        const double span = now.time - before.time, left = until_ - now.time;
        if (span > 0 && left > 0 && left <= kSeconds) {
            const sand::force::Vec3 old = leftAfter(now.place - before.place);
            force_ = old + (span / (left + span)) * (sand::force::shortened(wanted, maxForce_) - old);
        } else {
            force_ = wanted;
        }
        return force_;
    }
    /// Ends a cross-over: a fault sends 0 at once.
    void stop() { until_ = kNever; }

private:
    static constexpr double kNever = -std::numeric_limits<double>::infinity();

    /// Returns what is left of the last force after this `way` of the hand [m].
    [[nodiscard]] sand::force::Vec3 leftAfter(sand::force::Vec3 way) const {
        const double size = norm(force_);
        const double deeper = std::min(dot(way, force_) / size, 0.0);
        const double lost = stiffness_ * norm(way - (deeper / size) * force_);
        return (std::max(size - lost, 0.0) / size) * force_;
    }

    double stiffness_, maxForce_;  // [N/m], [N]
    Tick last_;
    sand::force::Vec3 force_;  // [N], of the last tick
    double until_ = kNever;    // [s], end of the cross-over
};

}  // namespace haptic_bridge
