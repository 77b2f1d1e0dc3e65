// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {

/// A law's answer as a force, without limits: push and friction, at a velocity [m/s].
[[nodiscard]] sand::force::Vec3 lawfulForce(const sand::force::Response& felt, sand::force::Vec3 velocity,
                                            double scale /* [scene unit/m] */);

/// The same law, made no stiffer and no more viscous than the limits say: constants lowered, so that it keeps its
/// shape. Sets the bits of the guards that took more than three hundredths away.
[[nodiscard]] sand::force::Vec3 limitedForce(const sand::force::Response& felt, sand::force::Vec3 velocity,
                                             const ForceLimits& limits, std::uint32_t& acted);

}  // namespace haptic_bridge
