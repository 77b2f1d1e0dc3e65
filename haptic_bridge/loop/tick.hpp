// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "haptic_bridge/hand/device.hpp"
#include "sand/force/vec3.hpp"
#include "sand/model/step.hpp"

namespace haptic_bridge {

/// Input of a hand at one tick. Together with the steps of a session it determines the forces.
struct TickInput {
    double time = 0;  // [s], argument of Device::read()
    Pose pose;
    ArmReading reading;
    std::int64_t nowNs = 0;         // [ns], time of the tick, see HapticTick::tick()
    std::int64_t surfaceAgeNs = 0;  // [ns], age of the sand at this tick
    std::uint64_t surfaceStep = 0;  // FeltSand::step
    sand::ProbePoint around;        // FeltSand::around
};

/// Complete record of one tick of the force loop. --record writes it, and a replay must reproduce it bit for bit.
struct Tick {
    double time = 0;                          // [s], argument of Device::read(); counts only while a master is linked
    sand::force::Vec3 armPlace, armVelocity;  // [m], [m/s], along the device's axes; 0 for a recording
    sand::force::Vec3 place, velocity;        // [scene unit], [scene unit/s], east, north, up
    sand::force::Vec3 lawful, sent;           // [N], scene axes, before and after the guards
    std::uint32_t guards = 0;                 // one bit for each guard that acted (hand/guard_counts.hpp)
    double surfaceAge = 0;                    // [s], age of the sand
    std::uint64_t surfaceStep = 0;            // number of the step whose sand was felt
    sand::ProbePoint sample;                  // probe point that goes into the steps
    bool engaged = false;
};

}  // namespace haptic_bridge
