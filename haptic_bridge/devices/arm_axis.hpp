// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

namespace haptic_bridge {

/// What holds the tip of an arm: a spring and a damper towards a target that goes along. Zeros: nobody.
struct Grip {
    double stiffness = 0;  // [N/m]
    double damping = 0;    // [N · s/m]
};

/// One axis of an arm: m x'' + b x' + F_c sgn(x') = force + grip, solved in closed form while the force is held.
struct ArmAxis {
    double place = 0;     // [m]
    double velocity = 0;  // [m/s]

    struct Body {
        double mass = 0.05;   // [kg]
        double damping = 0;   // [N · s/m]
        double friction = 0;  // [N], Coulomb
        Grip grip;
    };
    struct Target {
        double place = 0;     // [m], now
        double velocity = 0;  // [m/s], constant over the time advanced
    };

    /// By `time` [s] ≥ 0 under a constant force [N]: exact, Coulomb's stops and reversals included.
    void advance(const Body& body, double force, Target target, double time);
};

}  // namespace haptic_bridge
