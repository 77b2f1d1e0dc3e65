// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "haptic_bridge/devices/simulated_arm.hpp"

namespace test {

inline constexpr double kTick = 1e-3;  // [s], of the force loop

/// An arm as textbooks draw it: mass and damping, no friction, no encoder, no limits.
inline haptic_bridge::ArmPhysics textbookArm(double damping, int delayTicks = 0, double mass = 0.05) {
    haptic_bridge::ArmPhysics arm;
    arm.name = "textbook";
    arm.mass = mass;
    arm.damping = damping;
    arm.friction = 0;
    arm.resolution = 0;
    arm.maxForce = 1e300;
    arm.reach = 1e300;
    arm.delayTicks = delayTicks;
    return arm;
}

/// The greatest speed of the last fifth of a second over that of the first, of an arm that starts with 1 cm/s along x
/// under force = law(place); more than 1 diverges.
template <class Law>
double growth(const haptic_bridge::ArmPhysics& physics, Law law, double seconds = 3) {
    haptic_bridge::SimulatedArm arm(physics);
    arm.start({}, {0.01, 0, 0});
    const int ticks = static_cast<int>(seconds * 1000), window = 200;
    double first = 0, last = 0;
    for (int tick = 0; tick < ticks; ++tick) {
        const double place = arm.read(tick * 1e-3).place.x;
        arm.push({law(place), 0, 0});
        const double speed = std::abs(arm.velocity().x);
        if (!(speed < 1e6)) {
            return 1e6;
        }
        first = tick < window ? std::max(first, speed) : first;
        last = tick >= ticks - window ? std::max(last, speed) : last;
    }
    return last / first;
}

}  // namespace test
