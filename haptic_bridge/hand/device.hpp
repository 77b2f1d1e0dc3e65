// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "haptic_bridge/hand/arm.hpp"
#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Position of a hand in hand space (docs/devices.md), and how it holds the tool.
///
/// x runs east and y runs north from the centre of the field [half of the field's shorter side]. z is the height of the
/// tool's centre above the datum [tool radius]. At z = 1 the tool touches the datum; at z = 0 half of it is below. The
/// datum is the sand's surface below the hand, or the mean height of the surface, as the session began.
struct Pose {
    double x = 0, y = 0, z = 2;
    bool engaged = false;  // true: the tool may touch the sand; false: it hovers
    /// Direction in which the hand turns the tool [deg], counter-clockwise from east. nullopt: the tool keeps its
    /// heading.
    std::optional<double> heading = std::nullopt;
    bool leftFoot = false;  // with a heading: the tool's left and right are exchanged
};

class TroubleCounts;

/// Source of a hand: a haptic arm, a six-axis mouse, a stroke list or a recording.
///
/// One thread uses a device, except where a function allows any thread.
class Device {
public:
    Device() = default;
    virtual ~Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    /// Returns the hand's pose at `time` [s]. `time` counts only while a master is linked, and never decreases.
    [[nodiscard]] virtual Pose read(double time) = 0;
    /// Sends a force to the device, which holds it until the next call. A device without a body shows the force or
    /// ignores it. Only HapticTick calls this, with forces that the ForceGate has passed.
    virtual void sendForce(sand::force::Vec3 force /* [N], east, north, up */) = 0;
    /// Returns the physics of the arm that forces push, such as its mass and reach. Returns null if the device has no
    /// body, as a six-axis mouse or a recording.
    [[nodiscard]] virtual const ArmPhysics* physics() const { return nullptr; }
    /// Returns how far the tool moves when the tip of an arm moves one metre [scene unit/m]. If the vertical has a
    /// scale of its own, this is the larger of the two. The guards use it to convert the law's stiffness to [N/m].
    [[nodiscard]] virtual double scale() const { return 1; }
    /// Returns the last plausible reading of an arm, in the arm's own axes [m]. `present` is false if the latest read()
    /// got no plausible reading. A device without a body returns the default.
    [[nodiscard]] virtual ArmReading reading() const { return {}; }
    /// Returns whether the latest read() got a reading at all. A reading that is not plausible is a fault of the
    /// device; a missing one may only be late (Guards::kLate).
    [[nodiscard]] virtual bool answers() const { return true; }
    /// Returns how often each kind of trouble has happened, or null if the device counts no troubles. Any thread.
    [[nodiscard]] virtual const TroubleCounts* troubles() const { return nullptr; }
    /// Returns whether a recording has ended at `time` [s]. From then on it hovers where it ended. Other devices always
    /// return false.
    [[nodiscard]] virtual bool finished(double time) const = 0;
};

}  // namespace haptic_bridge
