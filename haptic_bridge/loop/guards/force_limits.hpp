// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "haptic_bridge/hand/arm.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

/// What a scene's law asks of a device at one radius' depth, where the first paper's constants are meant to be felt.
struct LawAtRadius {
    double stiffness = 0;  // [N/scene unit]
    double drag = 0;       // [N · frame/scene unit]
    double push = 0;       // [N]
};

/// Asks the scene's own force model, on level sand.
[[nodiscard]] LawAtRadius lawAtRadius(const scene::Scene& scene);

/// What forces a device can be trusted with: computed once, from its physics, the scale it works at and the law.
///
/// A sampled spring is stable while b > K (T/2 + t_d): one tick held, t_d until a force acts. Half of that K, or of
/// what the maker allows, is used: a Touch with a tick of delay rings for minutes at the whole, and for 2.4 s at half.
struct ForceLimits {
    static constexpr double kTick = 1e-3;          // [s]
    static constexpr double kFastestHand = 2;      // [m/s]
    static constexpr double kRamp = 2;             // [s]
    static constexpr double kStaleSurface = 0.05;  // [s]
    static constexpr double kGap = 0.01;           // [s] between two ticks, and ticks have been missed

    double scale = 1;             // [scene unit/m]
    double stiffness = 0;         // [N/m], K
    double damping = 0;           // [N · s/m], B of the device
    double internalFriction = 0;  // μ, tangent of the sand's talus
    double maxForce = 0;          // [N]
    double slew = 0;              // [N/tick]
    double gain = 1;              // of the law, so that it is no stiffer than K at one radius' depth
    double lawStiffness = 0;      // [N/m], of the law with that gain
    double resolution = 0;        // [m], of a reading
    double fastestThing = 20;     // [m/s]: no tip of an arm moves faster; infinite for a recording
    ArmPhysics arm;

    /// `probeStep` [m] is what places are rounded to on their way into the sand, besides the arm's own resolution.
    static ForceLimits of(const ArmPhysics& arm, double scale, const LawAtRadius& law, double internalFriction,
                          double probeStep = 0);

    /// The limits in words, a line each: what a person reads when a server starts. `constant` is the law's, as the
    /// scene has it.
    [[nodiscard]] std::vector<std::string> inWords(const std::string& name, double constant,
                                                   const LawAtRadius& law) const;
};

}  // namespace haptic_bridge
