// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Physical properties of an arm, from its data sheet or from measurements. The limits of its forces follow from them
/// (docs/forces.md). No number has a default. The server refuses a driver that leaves one out, or gives one outside
/// the bounds of haptic_bridge/hand/arm_numbers.hpp.
struct ArmPhysics {
    static constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();
    static constexpr int kNoDelayGiven = -1;

    std::string name;
    double mass = kNotGiven;          // [kg], apparent mass at the tip
    double damping = kNotGiven;       // [N · s/m], of the arm itself
    double friction = kNotGiven;      // [N], Coulomb friction
    double resolution = kNotGiven;    // [m]
    double maxForce = kNotGiven;      // [N]
    double reach = kNotGiven;         // [m], from the middle of its workspace
    double maxStiffness = kNotGiven;  // [N/m], largest that its maker allows; infinite if the maker states none
    int delayTicks = kNoDelayGiven;   // [tick of 1 ms], from reading a place until the force acts
};

/// One reading of an arm, in the arm's own axes.
struct ArmReading {
    sand::force::Vec3 place;  // [m], from the middle of its workspace
    bool first = false;       // button that touches the sand
    bool second = false;      // button that works as a clutch
    bool present = true;      // false: no reading, `place` does not count; after 10 ms the device gets no force
};

/// A device with a body. One thread reads it and pushes it at 1 kHz, in metres along the arm's own axes.
///
/// MappedDevice maps the arm to the sand. The guards make its forces safe. read() and push() neither wait nor allocate
/// memory.
class Arm {
public:
    Arm() = default;
    virtual ~Arm() = default;
    Arm(const Arm&) = delete;
    Arm& operator=(const Arm&) = delete;

    [[nodiscard]] virtual const ArmPhysics& physics() const = 0;
    /// Returns the arm's current reading. `time` [s] counts only while a master is linked, and never decreases.
    [[nodiscard]] virtual ArmReading read(double time) = 0;
    /// Pushes with `force`. The arm holds this force until the next call.
    virtual void push(sand::force::Vec3 force /* [N] */) = 0;
};

}  // namespace haptic_bridge
