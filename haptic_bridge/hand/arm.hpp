// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// What a maker's data sheet, or a measurement, says of a device: what its forces must be limited to (docs/forces.md).
struct ArmPhysics {
    std::string name;
    double mass = 0.05;                                             // [kg], apparent at the tip
    double damping = 0.5;                                           // [N · s/m], of its own
    double friction = 0;                                            // [N], Coulomb
    double resolution = 0;                                          // [m]
    double maxForce = 3.3;                                          // [N]
    double reach = 0.075;                                           // [m], from the middle of its workspace
    double maxStiffness = std::numeric_limits<double>::infinity();  // [N/m], as its maker allows
    int delayTicks = 0;                                             // [ms], from reading a place to acting on it
};

/// Where an arm is, in its own axes.
struct ArmReading {
    sand::force::Vec3 place;  // [m], from the middle of its workspace
    bool first = false;       // button: touch
    bool second = false;      // button: clutch
    bool present = true;      // false: the device does not answer, and gets no force
};

/// A device with a body: read and pushed at 1 kHz by one thread, in its own axes and in metres. What lies it over the
/// sand is MappedDevice; what makes its forces safe are the guards. read() and push() neither wait nor allocate.
class Arm {
public:
    Arm() = default;
    virtual ~Arm() = default;
    Arm(const Arm&) = delete;
    Arm& operator=(const Arm&) = delete;

    [[nodiscard]] virtual const ArmPhysics& physics() const = 0;
    /// `time` [s] since the session began; never runs backwards.
    [[nodiscard]] virtual ArmReading read(double time) = 0;
    /// Held until the next call.
    virtual void push(sand::force::Vec3 force /* [N] */) = 0;
};

}  // namespace haptic_bridge
