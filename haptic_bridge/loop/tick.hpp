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
    std::int64_t surfaceAgeNs = 0;  // [ns], since the sand was copied
    std::int64_t stepAgeNs = 0;     // [ns], since the newest step was made
    std::uint64_t surfaceStep = 0;  // FeltSand::step
    sand::ProbePoint surfaceProbe;  // FeltSand::probe
    double talus = 0;               // FeltSand::talus
    double share = 1;      // of each force that the hand may feel, as operators and the server's options have it
    bool edited = false;   // whether this is the first tick that feels a step with an edit
    bool silent = false;   // the device gave no reading: `reading` and `pose` are those of an earlier tick
    bool tripped = false;  // no force may be sent until an operator switches it on (Breaker)
};

/// Complete record of one tick of the force loop. --record writes it, and a replay must reproduce it bit for bit.
struct Tick {
    double time = 0;                          // [s], argument of Device::read(); counts only while a master is linked
    sand::force::Vec3 armPlace, armVelocity;  // [m], [m/s], along the device's axes; 0 for a recording
    sand::force::Vec3 place, velocity;        // [scene unit], [scene unit/s], east, north, up
    sand::force::Vec3 lawful, sent;           // [N], scene axes: by the law, and as the gate pushed it
    std::uint32_t guards = 0;                 // one bit for each guard that acted (hand/guard_counts.hpp)
    double surfaceAge = 0;                    // [s], since the sand was copied
    double stepAge = 0;                       // [s], since the newest step was made
    double share = 1;                         // TickInput::share
    double talus = 0;                         // TickInput::talus
    std::uint64_t surfaceStep = 0;            // number of the step whose sand was felt
    sand::ProbePoint probe;                   // of the hand, as it goes into the steps
    bool engaged = false;
    bool edited = false;  // TickInput::edited
};

}  // namespace haptic_bridge
