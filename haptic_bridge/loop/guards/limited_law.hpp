// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {

/// Returns the force of the law's response without limits: push and friction at `velocity` [m/s].
[[nodiscard]] sand::force::Vec3 lawfulForce(const sand::force::Response& felt, sand::force::Vec3 velocity,
                                            double scale /* [scene unit/m] */);

/// Returns the force of the law, at most as stiff and as viscous as `limits` allow. It lowers the law's constants, so
/// that the law keeps its shape. Sets the bit of each guard that took away more than three hundredths.
[[nodiscard]] sand::force::Vec3 limitedForce(const sand::force::Response& felt, sand::force::Vec3 velocity,
                                             const ForceLimits& limits, std::uint32_t& acted);

}  // namespace haptic_bridge
