// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "haptic_bridge/hand/arm.hpp"

namespace haptic_bridge {

inline constexpr std::array<std::string_view, 4> kArmPresets{"touch", "falcon", "omega.3", "delta.3"};

/// Returns the physics of the preset `name`, with a delay of one tick over USB. Returns nullopt if `name` is not in
/// kArmPresets.
[[nodiscard]] std::optional<ArmPhysics> armPreset(std::string_view name);

/// Returns the physics of a Touch, which succeeds the Phantom Omni of Purchart et al. 2012. Its limits also apply to a
/// recording, which has no body.
[[nodiscard]] ArmPhysics touchPreset();
inline constexpr double kTouchField = 0.16;  // [m], shorter side of a field over which a Touch reaches

}  // namespace haptic_bridge
