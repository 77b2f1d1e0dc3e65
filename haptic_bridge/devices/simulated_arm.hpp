// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "haptic_bridge/devices/arm_axis.hpp"
#include "haptic_bridge/hand/arm.hpp"

namespace haptic_bridge {

/// A simulated arm, for tests and for users without an arm. Each axis has mass, damping and Coulomb friction. The arm
/// also has an encoder, a delay, a motor with a greatest force, end stops, and a hand that follows a path.
///
/// The caller passes the time, so the arm works with a virtual clock and with the host's clock. Between two calls it
/// moves exactly as its equation says under the held forces. Used by one thread.
class SimulatedArm : public Arm {
public:
    /// Place to which the hand moves the tip [m], and whether it presses the button.
    struct Target {
        sand::force::Vec3 place;
        bool touches = true;
    };
    using Path = std::function<Target(double time /* [s] */)>;

    /// The arm starts at rest at the start of `path`. Without a path it starts in the middle of its workspace, and no
    /// hand holds it.
    explicit SimulatedArm(const ArmPhysics& physics, Grip grip = {}, Path path = {});

    [[nodiscard]] const ArmPhysics& physics() const override { return physics_; }
    /// Returns the reading at `time` [s], rounded to the encoder's resolution.
    [[nodiscard]] ArmReading read(double time) override;
    /// Pushes with `force`, reduced to the motor's greatest force. The force acts `delayTicks` milliseconds after the
    /// time that was read last. A force that is not finite counts as zero.
    void push(sand::force::Vec3 force) override;

    // Values that an encoder does not show, for tests and measurements.
    void start(sand::force::Vec3 place, sand::force::Vec3 velocity);
    void load(sand::force::Vec3 force /* [N] */) { load_ = force; }  // adds to the motor's force until the next call
    void letGo() { body_.grip = {}; }
    [[nodiscard]] sand::force::Vec3 place() const { return vector(&ArmAxis::place); }        // [m]
    [[nodiscard]] sand::force::Vec3 velocity() const { return vector(&ArmAxis::velocity); }  // [m/s]
    [[nodiscard]] double kineticEnergy() const;                                              // [J]

private:
    static constexpr std::size_t kMostPending = 32;  // twice the longest delay, because ticks may come early
    struct Pending {
        double due = 0;  // [s]
        sand::force::Vec3 force;
    };

    void advanceTo(double time, sand::force::Vec3 targetVelocity);
    [[nodiscard]] sand::force::Vec3 vector(double ArmAxis::*part) const {
        return {axes_[0].*part, axes_[1].*part, axes_[2].*part};
    }

    ArmPhysics physics_;
    ArmAxis::Body body_;
    Path path_;
    std::array<ArmAxis, 3> axes_;
    double time_ = 0;
    bool begun_ = false;
    Target target_;
    sand::force::Vec3 load_, acting_;
    std::array<Pending, kMostPending> pending_;  // ring buffer, oldest first
    std::size_t oldest_ = 0, waiting_ = 0;
};

/// Size of a stroke list's units in the arm's metres.
struct StrokeSpace {
    double halfSide = 0.064;  // [m] for 1 in the plane
    double radius = 0.0008;   // [m] for one tool radius in height; the tool touches level sand at 0
};

/// Opens "sim:PRESET[,KEY=VALUE]...". The keys are path=FILE.strokes or path=gis, grip=N/m, grip_damping=N·s/m, and
/// delay (ticks), damping, mass, friction, resolution, max_force and stiffness in the units and bounds of kArmNumbers.
/// Throws base::InputError.
[[nodiscard]] std::unique_ptr<SimulatedArm> openSimulatedArm(const std::string& spec, const StrokeSpace& space = {});

}  // namespace haptic_bridge
