// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "haptic_bridge/devices/arm_axis.hpp"
#include "haptic_bridge/hand/arm.hpp"

namespace haptic_bridge {

/// An arm that obeys physics, for tests and for whoever has none: mass, damping and Coulomb's friction on each axis,
/// an encoder, a delay, a motor that saturates, end stops, and a hand that follows a path.
///
/// Time is handed in: a virtual clock and the host's are alike to it. Between two calls it moves exactly as its
/// equation does under held forces. Used by one thread.
class SimulatedArm : public Arm {
public:
    /// Where the hand wants the tip to be [m], and whether it presses the button.
    struct Target {
        sand::force::Vec3 place;
        bool touches = true;
    };
    using Path = std::function<Target(double time /* [s] */)>;

    /// It starts at rest where the path does; without a path in the middle of its workspace, held by nobody.
    explicit SimulatedArm(const ArmPhysics& physics, Grip grip = {}, Path path = {});

    [[nodiscard]] const ArmPhysics& physics() const override { return physics_; }
    /// Rounded to the encoder's resolution.
    [[nodiscard]] ArmReading read(double time) override;
    /// Shortened to the motor's most; acts `delayTicks` milliseconds after the time read last. A force that is no
    /// number is none.
    void push(sand::force::Vec3 force) override;

    // What no encoder tells: for tests and measurements.
    void start(sand::force::Vec3 place, sand::force::Vec3 velocity);
    void load(sand::force::Vec3 force /* [N] */) { load_ = force; }  // besides the motor's, until changed
    void letGo() { body_.grip = {}; }
    [[nodiscard]] sand::force::Vec3 place() const { return vector(&ArmAxis::place); }        // [m]
    [[nodiscard]] sand::force::Vec3 velocity() const { return vector(&ArmAxis::velocity); }  // [m/s]
    [[nodiscard]] double kineticEnergy() const;                                              // [J]

private:
    static constexpr std::size_t kMostPending = 16;
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
    std::array<Pending, kMostPending> pending_;  // a ring, oldest first
    std::size_t oldest_ = 0, waiting_ = 0;
};

/// What the numbers of a stroke list are in an arm's metres.
struct StrokeSpace {
    double halfSide = 0.064;  // [m], of 1 in the plane
    double radius = 0.0008;   // [m], of a tool radius in height; the tool touches level sand at 0
};

/// "sim:PRESET[,KEY=VALUE]...": path=FILE.strokes or path=gis, grip=N/m, grip_damping=N·s/m, and delay (ticks),
/// damping, mass, friction, resolution, max_force, stiffness in ArmPhysics' units. Throws base::InputError.
[[nodiscard]] std::unique_ptr<SimulatedArm> openSimulatedArm(const std::string& spec, const StrokeSpace& space = {});

}  // namespace haptic_bridge
