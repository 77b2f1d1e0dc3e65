// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "haptic_bridge/hand/device.hpp"
#include "sand/force/vec3.hpp"
#include "sand/model/step.hpp"

namespace haptic_bridge {

/// Input of a hand at one tick. Together with the steps of a session it determines the forces.
struct TickInput {
    double time = 0;  // [s], of the device
    Pose pose;
    ArmReading reading;
    std::int64_t nowNs = 0;         // of the loop's clock
    std::int64_t surfaceAgeNs = 0;  // then
    std::uint64_t surfaceStep = 0;
    sand::ProbePoint around;  // FeltSand's, at height 0
};

/// One tick of the force loop, whole: what --record writes, and what a replay must find again bit for bit.
struct Tick {
    double time = 0;                          // [s] since the session began, the device's
    sand::force::Vec3 armPlace, armVelocity;  // [m], [m/s], the device's axes; 0 for a recording
    sand::force::Vec3 place, velocity;        // [scene unit], [scene unit/s], east, north, up
    sand::force::Vec3 lawful, sent;           // [N], scene axes, before and after the guards
    std::uint32_t guards = 0;                 // which acted, a bit each (guards.hpp)
    double surfaceAge = 0;                    // [s]
    std::uint64_t surfaceStep = 0;            // number of the step whose sand was felt
    sand::ProbePoint sample;                  // what goes into the steps
    bool engaged = false;
};

}  // namespace haptic_bridge
