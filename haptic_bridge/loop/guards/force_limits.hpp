// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "haptic_bridge/hand/arm.hpp"
#include "scene/model/scene.hpp"

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

/// Rate of the steps, and source of the force between two of them.
struct StepTiming {
    sand::Between between = sand::Between::local;
    double perSecond = 60;
};

/// Limits of the forces that a device can safely produce. They are computed once, from the device's physics, its scale
/// and the law.
///
/// A sampled spring is stable while b > K (T/2 + t_d): a force is held for one tick T, and acts after a delay t_d. The
/// limit is half of that K, or half of what the maker allows, whichever is smaller. At the full K a Touch with one tick
/// of delay rings for minutes; at half of it, for 2.4 s. If the force is held from step to step, T is the time of a
/// step; if it is interpolated between two steps, three times as much, because it is also a whole step late.
struct ForceLimits {
    static constexpr double kTick = 1e-3;          // [s]
    static constexpr double kFastestHand = 2;      // [m/s]
    static constexpr double kRamp = 2;             // [s]
    static constexpr double kStaleSurface = 0.05;  // [s]
    static constexpr double kGap = 0.01;           // [s], longest time between two ticks

    double scale = 1;               // [scene unit/m]
    double stiffness = 0;           // [N/m], K, largest stiffness
    double damping = 0;             // [N · s/m], B, largest damping
    double internalFriction = 0;    // μ, tangent of the sand's talus
    double maxForce = 0;            // [N]
    double slew = 0;                // [N/tick]
    double stepSeconds = 1.0 / 60;  // [s], time from one step to the next
    double heldSteps = 0;           // [step], time for which a force counts as held; 0: it is computed at every tick
    double gain = 1;                // factor on the law, so that it is at most as stiff as K at a depth of one radius
    double lawStiffness = 0;        // [N/m], stiffness of the law with that gain
    double resolution = 0;          // [m], of a place that reaches the law
    double fastestThing = 20;       // [m/s], faster than any tip of an arm; infinite for a recording
    ArmPhysics arm;

    /// Returns the limits of `arm` at `scale` [scene unit/m]. `probeStep` [m] is the rounding of places on their way
    /// into the sand; it adds to the arm's own resolution. Throws base::InputError if the law's demands are not finite
    /// at that scale, because no gain would lower them.
    static ForceLimits of(const ArmPhysics& arm, double scale, const LawAtRadius& law, double internalFriction,
                          double probeStep = 0, const StepTiming& steps = {});
    /// Returns which share of `stiffness` the device bears while the newest step is `age` [s] old. It is 1 until a step
    /// comes late.
    [[nodiscard]] double shareForStepOf(double age) const;

    /// Returns lines that a server prints at its start: the limits and the reason for each. `constant` is the law's
    /// constant `name` in the scene.
    [[nodiscard]] std::vector<std::string> inWords(const std::string& name, double constant,
                                                   const LawAtRadius& law) const;

private:
    /// Returns the stiffness at which a spring diverges whose force is held for `seconds` [N/m].
    [[nodiscard]] double sampledAt(double seconds) const;
    [[nodiscard]] double stiffnessAt(double seconds) const;
    /// Returns for how long a force counts as held while the newest step is `age` [s] old.
    [[nodiscard]] double heldSeconds(double age) const;
    [[nodiscard]] std::string reason() const;
};

}  // namespace haptic_bridge
