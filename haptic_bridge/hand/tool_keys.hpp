// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/hand/pointer_hand.hpp"
#include "scene/model/material.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {

/// Smallest and largest radius to which keys and the wheel change the tool [scene unit].
struct ToolLimits {
    double least = 0, most = 0;
    double usual = 0;  // size of a tool that can be seen, scene::usualToolRadius()

    /// Returns the limits for the sand of `scene`: the tool is from two cells to a quarter of the field's shorter side
    /// long. So a held key cannot lose it.
    [[nodiscard]] static ToolLimits of(const scene::Scene& scene);
    /// Returns the radius after `notches` of the wheel or presses of a key, each by a factor of 1.25; negative ones
    /// make it smaller. A tool of a scene may be outside of the limits. A change towards them then goes to the nearer
    /// one at least, and a change away from them does nothing.
    [[nodiscard]] double resized(double radius, double notches) const;
};

// Depth of the pointer's tool: how far its underside is below the sand's surface [tool radius].
inline constexpr double kUsualDepth = PointerHand::kUsualDepth, kDepthPerNotch = 0.1;
inline constexpr double kShallowest = PointerHand::kShallowest;
inline constexpr double kDeepest = PointerHand::kDeepest;
/// Returns the depth after `notches` of the wheel, positive towards the user, within its limits.
[[nodiscard]] double deepened(double depth, double notches);

inline constexpr double kTurnDegrees = 5;     // by which a key turns the tool
inline constexpr double kMoreHumidity = 0.1;  // by which a key makes sand wetter or drier

/// Returns a heading turned by `degrees` counter-clockwise, within [0, 360) [deg].
[[nodiscard]] double turned(double heading, double degrees);
/// Returns a humidity that was raised by `more`, within [0, 1] and without the noise of sums of tenths.
[[nodiscard]] double moistened(double humidity, double more);

}  // namespace haptic_bridge
