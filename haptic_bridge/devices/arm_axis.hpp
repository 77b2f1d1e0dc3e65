// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

namespace haptic_bridge {

/// Grip of a hand at the tip of an arm: a spring and a damper towards a target that moves with the hand. If both are 0,
/// no hand holds the arm.
struct Grip {
    double stiffness = 0;  // [N/m]
    double damping = 0;    // [N · s/m]
};

/// One axis of an arm: m x'' + b x' + F_c sgn(x') = force + grip. It is solved in closed form while the force is held.
struct ArmAxis {
    double place = 0;     // [m]
    double velocity = 0;  // [m/s]

    struct Body {
        double mass = 0.05;   // [kg]
        double damping = 0;   // [N · s/m]
        double friction = 0;  // [N], Coulomb friction
        Grip grip;
    };
    struct Target {
        double place = 0;     // [m], at the start of the time advanced
        double velocity = 0;  // [m/s], constant during the time advanced
    };

    /// Advances the axis by `time` [s] ≥ 0 under a constant `force` [N]. The motion is exact, with stops and reversals
    /// by Coulomb friction.
    void advance(const Body& body, double force, Target target, double time);
};

}  // namespace haptic_bridge
