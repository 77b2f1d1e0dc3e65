// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "haptic_bridge/devices/mapped_device.hpp"
#include "haptic_bridge/hand/path_builder.hpp"
#include "haptic_bridge/loop/felt_sand.hpp"
#include "tests/support/hand/arm_on_sand.hpp"

/// Hands in sand that is displaced and erodes, under a virtual clock.
namespace test {

/// Returns level sand of 512 × 512 cells with a tool of ten cells, as in scenes/writing.toml.
inline scene::Scene writingSand(sand::Between between) {
    sand::ForceConstants constants;
    constants.between = between;
    scene::Scene scene = levelSand(constants);
    scene.rules.tuning.sweepsPerStep = 18;  // a tool of ten cells with a settling time of 0.1 s
    scene.rules.tuning.tool.radius = static_cast<std::int32_t>(std::lround(0.04 * 256 * sand::kProbePerCell));
    return scene;
}

/// The whole loop of a haptic server, without threads and sockets. It has ticks of 1 ms with all guards, the hand's
/// path, steps, and copies of the sand.
class HandInSand {
public:
    /// `scene` must outlive this object.
    HandInSand(const scene::Scene& scene, std::unique_ptr<haptic_bridge::Arm> arm)
        : sand_(scene),
          hand_(scene,
                std::make_unique<haptic_bridge::MappedDevice>(std::move(arm), haptic_bridge::HandSettings{}, scene),
                haptic_bridge::HandSettings::Datum::level),
          path_(scene.rules.stepsPerSecond) {
        publish();
    }

    /// Runs a tick, and makes a step after it if one is due.
    const haptic_bridge::Tick& tick() {
        nowNs_ += kTickNs;
        surface_.timeNs = nowNs_;
        path_.add(hand_.tick(time(), nowNs_, surface_));
        const std::int64_t due = nowNs_ * stepsPerSecond / 1'000'000'000;
        if (std::exchange(due_, due) != due && !paused) {
            sand::Step step{1, sand_.stepNumber() + 1, false, {}};
            (void)path_.take(step);
            sand_.apply(step);
            publish();
        }
        return hand_.lastTick();
    }
    [[nodiscard]] double time() const { return static_cast<double>(nowNs_) * 1e-9; }  // [s]
    [[nodiscard]] const haptic_bridge::ForceLimits& limits() const { return hand_.guards().limits(); }

    bool paused = false;      // no steps are made. The hand still gets new copies of the same sand
    int stepsPerSecond = 60;  // that are made, whatever the scene's rules say

private:
    static constexpr std::int64_t kTickNs = 1'000'000;

    void publish() {
        haptic_bridge::takeSurface(sand_, hand_.probe(), surface_);
        surface_.stepNs = nowNs_;
    }

    sand::Replica sand_;
    haptic_bridge::HapticTick hand_;
    haptic_bridge::PathBuilder path_;
    haptic_bridge::FeltSand surface_;
    std::int64_t nowNs_ = 0;
    std::int64_t due_ = 0;  // number of steps that were due until now
};

inline constexpr haptic_bridge::Grip kUsualGrip{300, 5};
/// A light grip. With `hold` or `interpolate` an omega.3 and a delta.3 never come to rest in it at the stiffness of
/// `local`.
inline constexpr haptic_bridge::Grip kLightGrip{100, 0};

/// An arm whose hand presses one tool radius deep, digs a furrow of 0.6 half sides in 3 s, and then holds still. The
/// hand presses deeper if dry friction carries the arm.
class DiggingHand {
public:
    static constexpr double kBegins = 2.1, kGoesDown = 0.2, kWaits = 1, kDigs = 3;  // [s]
    static constexpr double kHolds = kBegins + kGoesDown + kWaits + kDigs;          // [s], when the hand holds still

    /// `scene` must outlive this object.
    DiggingHand(const scene::Scene& scene, const ArmPhysics& physics, const haptic_bridge::Grip& grip)
        : DiggingHand(scene, std::make_unique<SimulatedArm>(physics, grip, pathOver(scene, physics, grip))) {}

    void runUntilItHolds() {
        while (loop_.time() < kHolds) {
            (void)loop_.tick();
        }
    }
    /// Runs ticks for `seconds`. Returns the arm's speed after each [m/s].
    std::vector<double> run(double seconds) {
        std::vector<double> speeds;
        for (long ticks = std::lround(seconds * 1000); ticks > 0; --ticks) {
            sent_ = norm(loop_.tick().sent);
            speeds.push_back(norm(arm_->velocity()));
        }
        return speeds;
    }
    [[nodiscard]] double sent() const { return sent_; }  // [N], at the last tick
    [[nodiscard]] HandInSand& loop() { return loop_; }

private:
    DiggingHand(const scene::Scene& scene, std::unique_ptr<SimulatedArm> arm)
        : arm_(arm.get()), loop_(scene, std::move(arm)) {}

    [[nodiscard]] static SimulatedArm::Path pathOver(const scene::Scene& scene, const ArmPhysics& physics,
                                                     const haptic_bridge::Grip& grip) {
        const double scale = haptic_bridge::MappedDevice::scaleFor(physics, {}, scene);  // [scene unit/m]
        const double radius = scene.toolRadius() / scale;                                // [m]
        const double depth = radius + physics.friction / grip.stiffness;                 // [m]
        return [=](double time) -> SimulatedArm::Target {
            const double down = std::clamp((time - kBegins) / kGoesDown, 0.0, 1.0);
            const double along = std::clamp((time - kBegins - kGoesDown - kWaits) / kDigs, 0.0, 1.0);
            return {{(0.6 * along - 0.3) / scale, 0, radius - (radius + depth) * down}};
        };
    }

    SimulatedArm* arm_;  // of the loop
    HandInSand loop_;
    double sent_ = 0;
};

/// Returns after which time all of `speeds` [m/s], one a tick, are below 1 mm/s [s]. Infinite if one of the last 0.5 s
/// is not: such an arm has not come to rest.
inline double restsAfter(const std::vector<double>& speeds) {
    constexpr std::ptrdiff_t kQuiet = 500;  // [tick]
    const auto moving = std::find_if(speeds.rbegin(), speeds.rend(), [](double speed) { return !(speed < 1e-3); });
    return moving - speeds.rbegin() < kQuiet ? std::numeric_limits<double>::infinity()
                                             : 1e-3 * static_cast<double>(speeds.rend() - moving);
}

}  // namespace test
