// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "haptic_bridge/hand/arm.hpp"
#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Where a hand is, in hand space (docs/devices.md).
///
/// x runs east and y north from the centre of the field; 1 is half of the field's shorter side. z is the height of the
/// tool's centre over the sand's surface as the session began [tool radius]: 1 touches it, 0 is half sunk.
struct Pose {
    double x = 0, y = 0, z = 2;
    bool engaged = false;  // may touch the sand; otherwise the tool hovers
    /// Which way the hand turns the tool [deg] from east, counter-clockwise; none: it stays as it is.
    std::optional<double> heading = std::nullopt;
    bool leftFoot = false;  // with a heading: the tool's left and right are exchanged
};

class SandWatcher;
class TroubleCounts;

/// A haptic device, or what stands in for one. Used by one thread.
class Device {
public:
    Device() = default;
    virtual ~Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    /// Where the hand is at `time` [s] since the session began; times never run backwards.
    [[nodiscard]] virtual Pose read(double time) = 0;
    virtual void sendForce(sand::force::Vec3 force /* [N], east, north, up */) = 0;
    /// The body that is pushed, and how far its tip goes; null for a recording, which feels nothing.
    [[nodiscard]] virtual const ArmPhysics* physics() const { return nullptr; }
    /// [scene unit/m] of a body's movement: the guards' limits hold for forces after this.
    [[nodiscard]] virtual double scale() const { return 1; }
    /// Where a body was read last, in its own axes [m], and whether it answered; a recording has no such place.
    [[nodiscard]] virtual ArmReading reading() const { return {}; }
    /// What the device has done wrong, any thread; null for what does nothing wrong.
    [[nodiscard]] virtual const TroubleCounts* troubles() const { return nullptr; }
    /// Who wants to see the sand; null for most.
    [[nodiscard]] virtual SandWatcher* watcher() { return nullptr; }
    /// Any thread: of the force that is sent, this share, 0 to 1, reaches the body; a change is ramped.
    virtual void shareForce(double /* share */) {}
    /// Whether a recording is over: from then on it hovers where it is.
    [[nodiscard]] virtual bool finished(double time) const = 0;
};

}  // namespace haptic_bridge
