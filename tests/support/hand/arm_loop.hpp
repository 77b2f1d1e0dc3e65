// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptic_bridge/devices/simulated_arm.hpp"

namespace test {

inline constexpr double kTick = 1e-3;  // [s], length of one tick of the force loop

/// Returns an arm as in textbooks: mass and damping, without friction, encoder steps or limits.
inline haptic_bridge::ArmPhysics textbookArm(double damping, int delayTicks = 0, double mass = 0.05) {
    haptic_bridge::ArmPhysics arm;
    arm.name = "textbook";
    arm.mass = mass;
    arm.damping = damping;
    arm.friction = 0;
    arm.resolution = 0;
    arm.maxForce = 1e300;
    arm.reach = 1e300;
    arm.maxStiffness = std::numeric_limits<double>::infinity();
    arm.delayTicks = delayTicks;
    return arm;
}

/// Returns the greatest speed of the last 0.2 s, divided by that of the first 0.2 s. The arm starts with 1 cm/s along x
/// under force = law(place). A result above 1 means that the motion diverges.
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
