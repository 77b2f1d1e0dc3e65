// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "haptic_bridge/hand/arm.hpp"

namespace haptic_bridge {

inline constexpr std::array<std::string_view, 4> kArmPresets{"touch", "falcon", "omega.3", "delta.3"};

/// One of kArmPresets, as a tick of delay over USB leaves it; nothing for another name.
[[nodiscard]] std::optional<ArmPhysics> armPreset(std::string_view name);

/// What a recording is felt with, which has no body: the first paper's kind of device.
[[nodiscard]] ArmPhysics touchPreset();
inline constexpr double kTouchField = 0.16;  // [m], the shorter side of a field that a Touch reaches over

}  // namespace haptic_bridge
