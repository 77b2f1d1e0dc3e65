// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/hand/arm.hpp"

namespace test {

/// Returns an arm without a body of its own: it moves along the test's path, whatever pushes it. Its slew limit is
/// 0.667 N per tick: K is half of 1 N s/m over 1.5 ms, times 2 m/s.
inline haptic_bridge::ArmPhysics strongArm() {
    haptic_bridge::ArmPhysics arm;
    arm.name = "strong";
    arm.mass = 0.2;
    arm.damping = 1;
    arm.friction = 0.3;
    arm.resolution = 2e-5;
    arm.maxForce = 8;
    arm.reach = 0.06;
    arm.maxStiffness = 2000;
    arm.delayTicks = 1;
    return arm;
}

}  // namespace test
