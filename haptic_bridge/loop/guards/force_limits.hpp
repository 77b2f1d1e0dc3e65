// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "haptic_bridge/hand/arm.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

/// Demands of a scene's law on a device at a depth of one tool radius. The constants of Dorjgotov et al. 2007 are meant
/// for that depth.
struct LawAtRadius {
    double stiffness = 0;  // [N/scene unit]
    double drag = 0;       // [N · frame/scene unit]
    double push = 0;       // [N]
};

/// Returns the demands of the scene's force model on level sand.
[[nodiscard]] LawAtRadius lawAtRadius(const scene::Scene& scene);

/// Limits of the forces that a device can safely produce. They are computed once, from the device's physics, its scale
/// and the law.
///
/// A sampled spring is stable while b > K (T/2 + t_d): a force is held for one tick T, and acts after a delay t_d. The
/// limit is half of that K, or half of what the maker allows, whichever is smaller. At the full K a Touch with one tick
/// of delay rings for minutes; at half of it, for 2.4 s.
struct ForceLimits {
    static constexpr double kTick = 1e-3;          // [s]
    static constexpr double kFastestHand = 2;      // [m/s]
    static constexpr double kRamp = 2;             // [s]
    static constexpr double kStaleSurface = 0.05;  // [s]
    static constexpr double kGap = 0.01;           // [s], longest time between two ticks

    double scale = 1;             // [scene unit/m]
    double stiffness = 0;         // [N/m], K, largest stiffness
    double damping = 0;           // [N · s/m], B, largest damping
    double internalFriction = 0;  // μ, tangent of the sand's talus
    double maxForce = 0;          // [N]
    double slew = 0;              // [N/tick]
    double gain = 1;              // factor on the law, so that it is at most as stiff as K at a depth of one radius
    double lawStiffness = 0;      // [N/m], stiffness of the law with that gain
    double resolution = 0;        // [m], of a place that reaches the law
    double fastestThing = 20;     // [m/s], faster than any tip of an arm; infinite for a recording
    ArmPhysics arm;

    /// Returns the limits of `arm` at `scale` [scene unit/m]. `probeStep` [m] is the rounding of places on their way
    /// into the sand; it adds to the arm's own resolution.
    static ForceLimits of(const ArmPhysics& arm, double scale, const LawAtRadius& law, double internalFriction,
                          double probeStep = 0);

    /// Returns lines that a server prints at its start: the limits and the reason for each. `constant` is the law's
    /// constant `name` in the scene.
    [[nodiscard]] std::vector<std::string> inWords(const std::string& name, double constant,
                                                   const LawAtRadius& law) const;
};

}  // namespace haptic_bridge
