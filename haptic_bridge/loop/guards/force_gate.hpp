// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "haptic_bridge/loop/guards/slew.hpp"
#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// The last guard before the device. Every force that a device gets has passed it, whatever the guards before it did.
///
/// Bounds of a passed force, at every tick:
/// - It is finite, and its norm is at most the device's greatest force.
/// - It grows or turns by at most kMostSlews slew limits. It may fall at once.
/// - After a start and after every tick in which a fault sent 0, it grows from 0 to its full size within
///   ForceLimits::kRamp.
/// - If a contact or an edit asks at once for more than the last passed force and one slew limit, the excess grows from
///   0 to its full size within kContactSeconds. A contact that begins at the surface asks for less.
///
/// Used by one thread; allocates no memory.
class ForceGate {
public:
    static constexpr double kMostSlews = 1.5;  // change of the law along a fast way, observer and reversing friction
    static constexpr double kContactSeconds = 0.2;  // [s]

    explicit ForceGate(const ForceLimits& limits)
        : maxForce_(limits.maxForce), slew_(limits.slew), follower_(kMostSlews * limits.slew) {}

    /// What a tick without faults asks for.
    struct Wanted {
        double time = 0;          // [s]
        sand::force::Vec3 force;  // [N], after all other guards
        double whole = 0;  // [N], norm that the force reaches without slew: within the device's, in the hand's share
        bool contact = false;  // the limited force is above 0
        bool edited = false;   // the first tick that feels a step with an edit
    };
    /// Returns the force to push, and sets the bit of each guard that acted.
    [[nodiscard]] sand::force::Vec3 pass(const Wanted& wanted, std::uint32_t& acted);
    /// Returns the part `share` of the last passed force, 0 to 1, and passes it. For a tick that has no reading.
    [[nodiscard]] sand::force::Vec3 shorten(double share);
    /// Returns which part of the last wanted force was passed, 0 to 1, beside the ramp; 0 after a fault.
    [[nodiscard]] double passed() const { return passed_; }
    /// Begins the ramp. Call it at a start, and at every tick whose fault sends 0.
    void restart(double time /* [s] */);

private:
    [[nodiscard]] double ramped(double time) const;
    [[nodiscard]] double mostInContact(const Wanted& wanted, double whole);

    double maxForce_, slew_;  // [N], [N/tick]
    Slew follower_;
    double rampFrom_ = 0;              // [s]
    double pushed_ = 0;                // [N], norm of the last passed force
    double passed_ = 0;                // passed()
    bool contact_ = false;             // at the last tick
    bool grows_ = false;               // whether the excess of a contact or an edit still grows
    double growsFrom_ = 0, base_ = 0;  // [s], [N]: when the growth began, and the force at that time
};

}  // namespace haptic_bridge
