// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "haptic_bridge/devices/simulated_arm.hpp"
#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/loop/haptic_tick.hpp"
#include "scene/model/scene.hpp"

namespace test {

using haptic_bridge::ArmPhysics;
using haptic_bridge::SimulatedArm;
using sand::force::Vec3;

inline constexpr double kScale = haptic_bridge::kTouchField > 0 ? 2 / haptic_bridge::kTouchField : 0;  // [unit/m]
inline constexpr double kPapersRadius = 0.01;                                                          // [scene unit]

/// Returns a scene of level sand, by default the field (−1,1)² of Dorjgotov et al. 2007. The tool's radius is 0.01.
inline scene::Scene levelSand(const sand::ForceConstants& force = {}, int cells = 512, double side = 2) {
    scene::Scene scene;
    scene.terrain = sand::HeightField(cells, cells, side / cells);
    scene.force = force;
    scene.rules.columns = scene.rules.rows = cells;
    scene.rules.tuning.threshold = scene.rules.tuning.startThreshold = 44204;  // 34 degrees
    scene.rules.tuning.sweepsPerStep = 16;
    scene.rules.stepsPerSecond = 60;
    scene.rules.tuning.tool.radius =
        static_cast<std::int32_t>(std::lround(kPapersRadius * cells / side * sand::kProbePerCell));
    return scene;
}

/// An arm above the middle of the field, with the axes of the scene. At height 0 the tool touches level sand.
class ArmOnSand : public haptic_bridge::Device {
public:
    /// `claimed` is the description that the arm's driver gives, which may be wrong.
    ArmOnSand(std::unique_ptr<SimulatedArm> arm, const scene::Scene& scene, const ArmPhysics& claimed)
        : arm_(std::move(arm)),
          claimed_(claimed),
          halfSide_(scene.terrain.columns() * scene.terrain.cellSize() / 2),
          radius_(scene.toolRadius()) {}

    [[nodiscard]] haptic_bridge::Pose read(double time) override {
        reading_ = arm_->read(time);
        const Vec3 at = reading_.place;
        return {at.x * kScale / halfSide_, at.y * kScale / halfSide_, 1 + at.z * kScale / radius_, true};
    }
    void sendForce(Vec3 force) override { arm_->push(force); }
    [[nodiscard]] const ArmPhysics* physics() const override { return &claimed_; }
    [[nodiscard]] double scale() const override { return kScale; }
    [[nodiscard]] haptic_bridge::ArmReading reading() const override { return reading_; }
    [[nodiscard]] bool finished(double) const override { return false; }

private:
    std::unique_ptr<SimulatedArm> arm_;
    ArmPhysics claimed_;
    double halfSide_, radius_;  // [scene unit]
    haptic_bridge::ArmReading reading_;
};

/// One arm, one hand and one surface under a virtual clock.
class ArmSession {
public:
    ArmSession(const scene::Scene& scene, std::unique_ptr<SimulatedArm> arm,
               haptic_bridge::Guards::Mode mode = haptic_bridge::Guards::Mode::on)
        : ArmSession(scene, std::move(arm), mode, nullptr) {}
    /// `claimed` is the description of the arm that the guards get. If it is null, they get the true one.
    ArmSession(const scene::Scene& scene, std::unique_ptr<SimulatedArm> arm, haptic_bridge::Guards::Mode mode,
               const ArmPhysics* claimed)
        : arm_(arm.get()),
          hand_(scene,
                std::make_unique<ArmOnSand>(std::move(arm), scene, claimed != nullptr ? *claimed : arm_->physics()),
                haptic_bridge::HandSettings::Datum::level, mode) {
        const std::int32_t middle = scene.rules.columns / 2 * sand::kProbePerCell;
        surface_.patch = {scene.terrain, {middle, middle, 0}, scene.toolRadius()};
        surface_.tool = sand::force::Contour::sphere(scene.toolRadius());
        surface_.talus = static_cast<double>(scene.rules.tuning.threshold) / sand::kUnitsPerCell;
    }

    /// Runs a tick on a surface that was copied `age` ago [s], `span` after the tick before [s]. The newest step was
    /// made `stepAge` ago [s].
    const haptic_bridge::Tick& tick(double age = 0, double span = 1e-3, double stepAge = 0) {
        time_ += span;
        const auto now = static_cast<std::int64_t>(time_ * 1e9);
        surface_.timeNs = now - static_cast<std::int64_t>(age * 1e9);
        surface_.stepNs = now - static_cast<std::int64_t>(stepAge * 1e9);
        sample_ = hand_.tick(time_, now, surface_);
        return hand_.lastTick();
    }
    /// Runs ticks with the tool in the air, until the force ramp of the start is over.
    void warmUp() {
        arm_->start({0, 0, 0.002}, {});
        for (int i = 0; i < 2010; ++i) {
            (void)tick();
        }
    }
    [[nodiscard]] SimulatedArm& arm() { return *arm_; }
    [[nodiscard]] haptic_bridge::HapticTick& hand() { return hand_; }
    [[nodiscard]] haptic_bridge::FeltSand& surface() { return surface_; }
    [[nodiscard]] const haptic_bridge::HandSample& sample() const { return sample_; }
    [[nodiscard]] double time() const { return time_; }

private:
    SimulatedArm* arm_;
    haptic_bridge::HapticTick hand_;
    haptic_bridge::FeltSand surface_;
    haptic_bridge::HandSample sample_;
    double time_ = 0;
};

/// One trial of the sweep: an arm is put into level sand at a depth and a speed. It must come to rest.
struct Trial {
    ArmPhysics arm;
    double depth = 1;   // [tool radius]
    double speed = 0;   // [m/s]
    bool held = false;  // by a hand that moves to and fro for half a second; otherwise a weight presses
    haptic_bridge::Guards::Mode mode = haptic_bridge::Guards::Mode::on;
};
struct Outcome {
    double lastSpeed = 0;  // [m/s], greatest speed of the last tenth of a second
    double allowed = 0;    // [s], time in which the arm must come to rest
    double mostForce = 0;  // [N], greatest force sent
    double deviation = 0;  // largest difference between the sent force and the law, as a share of the law's force. The
                           // law has the constants printed at the start. Depths to 3.5 radii, without other limits.
    long touching = 0;     // [tick], ticks in which the tool touches the sand
    long unlimited = 0;    // [tick], touching ticks in which only the constants limit the force
    long damped = 0;       // [tick], ticks in which the passivity observer damps
    [[nodiscard]] bool settles() const { return lastSpeed < 1e-3; }
};

inline SimulatedArm::Path toAndFro(double depth /* [m] */, double speed /* [m/s] */, double from /* [s] */) {
    return [=](double time) -> SimulatedArm::Target {
        constexpr double kReach = 0.02, kMoves = 0.5;  // [m], [s]
        const double gone = speed * std::clamp(time - from, 0.0, kMoves);
        const double phase = std::fmod(gone, 4 * kReach);
        const double x = phase < kReach ? phase : phase < 3 * kReach ? 2 * kReach - phase : phase - 4 * kReach;
        return {{x, 0, time < from ? 0.002 : -depth}, true};
    };
}

/// Runs a trial. The arm must be slower than 1 mm/s after 3 s. A heavy arm may need longer to stop by its damping
/// alone. It gets the time of the slowest loop within its limits, in which half of the damping is left: decay at b/4m.
inline Outcome run(const Trial& trial, const scene::Scene& scene) {
    const double depth = trial.depth * scene.toolRadius() / kScale;  // [m]
    constexpr double kWarm = 2.01;
    constexpr haptic_bridge::Grip kGrip{300, 5};
    auto arm = trial.held ? std::make_unique<SimulatedArm>(trial.arm, kGrip, toAndFro(depth, trial.speed, kWarm))
                          : std::make_unique<SimulatedArm>(trial.arm);
    ArmSession session(scene, std::move(arm), trial.mode);
    session.warmUp();
    const auto& limits = session.hand().guards().limits();
    Outcome outcome;
    double fastest = std::max(trial.speed, 1e-3);
    if (!trial.held) {
        const bool literal = trial.mode == haptic_bridge::Guards::Mode::literal;
        const double stiffness = limits.lawStiffness / (literal ? limits.gain : 1);
        const double pressed = std::min(stiffness * depth, 0.5 * trial.arm.maxForce);
        if (!literal) {
            // The contact begins at the surface, two steps of the encoder deep. In the deep it would begin with a ramp.
            session.arm().start({0, 0, -2 * std::max(trial.arm.resolution, 1e-5)}, {});
            (void)session.tick();
        }
        session.arm().load({0, 0, -pressed});
        session.arm().start({0, 0, -depth}, {0.8 * trial.speed, 0, -0.6 * trial.speed});
        fastest = std::hypot(trial.speed, pressed / std::sqrt(limits.lawStiffness * trial.arm.mass));
    }
    const double damping = trial.arm.damping + (trial.held ? kGrip.damping : 0);
    outcome.allowed = std::max(3.0, 4 * trial.arm.mass / damping * std::log(fastest / 1e-3)) + (trial.held ? 0.5 : 0);
    const long ticks = std::lround(outcome.allowed * 1000);
    for (long i = 0; i < ticks; ++i) {
        const haptic_bridge::Tick& tick = session.tick();
        const double law = limits.gain * norm(tick.lawful);
        outcome.mostForce = std::max(outcome.mostForce, norm(tick.sent));
        outcome.damped += (tick.guards & bit(haptic_bridge::Guard::passivity)) != 0 ? 1 : 0;
        if (law > 0) {
            ++outcome.touching;
            // Below the depths of the sweep the law is stiffer than its constants say at one radius. There the guards
            // hold it to K.
            const bool deeper = tick.place.z - scene.toolRadius() < -3.5 * scene.toolRadius();
            if (!deeper && (tick.guards & ~bit(haptic_bridge::Guard::stiffness)) == 0) {
                ++outcome.unlimited;
                outcome.deviation = std::max(outcome.deviation, norm(tick.sent - limits.gain * tick.lawful) / law);
            }
        }
        if (i >= ticks - 100) {
            outcome.lastSpeed = std::max(outcome.lastSpeed, norm(session.arm().velocity()));
        }
    }
    return outcome;
}

}  // namespace test
