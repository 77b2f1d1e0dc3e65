// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {

/// Returns the force of the law's response without limits: push and friction at `velocity` [m/s].
[[nodiscard]] sand::force::Vec3 lawfulForce(const sand::force::Response& felt, sand::force::Vec3 velocity,
                                            double scale /* [scene unit/m] */);

/// The limits of one tick.
struct LimitsNow {
    const ForceLimits& limits;
    double softness;  // factor on the stiffness, 0 to 1
    double talus;     // tangent of the talus of the sand at the hand

    LimitsNow(const ForceLimits& all, double soft, double tangent) : limits(all), softness(soft), talus(tangent) {}
    /// The limits at the start of a session.
    LimitsNow(const ForceLimits& all) : LimitsNow(all, 1, all.internalFriction) {}  // NOLINT: meant to convert
};

/// Returns the force of the law, at most as stiff and as viscous as `now` allows. It lowers the law's constants, so
/// that the law keeps its shape. Sets the bit of each guard that took away more than three hundredths.
[[nodiscard]] sand::force::Vec3 limitedForce(const sand::force::Response& felt, sand::force::Vec3 velocity,
                                             const LimitsNow& now, std::uint32_t& acted);

}  // namespace haptic_bridge
