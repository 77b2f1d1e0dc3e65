// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/force_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptic_bridge/loop/guards/velocity_window.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {
namespace {

constexpr double kRest = 1e-3;  // [m/s]; a slower arm counts as resting
constexpr double kQuiet = 0.6;  // margin: chatter is not a sine, and was measured up to 1.4 times as fast

/// Rounds a number to `digits` digits, so that it is easy to read: 19, 130, 0.19.
double rounded(double number, int digits = 2) {
    if (!(std::abs(number) > 0) || !std::isfinite(number)) {
        return number;
    }
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(number))) + 1 - digits);
    return std::round(number / unit) * unit;
}

}  // namespace

LawAtRadius lawAtRadius(const scene::Scene& scene) {
    const double radius = scene.toolRadius();
    if (!(radius > 0)) {
        return {};
    }
    constexpr int kCells = 33, kPerRadius = 4;
    const sand::HeightField level(kCells, kCells, radius / kPerRadius);
    constexpr int kMiddle = kCells / 2 * sand::kProbePerCell + sand::kProbePerCell / 2;
    const sand::force::SurfacePatch patch(level, {kMiddle, kMiddle, 0}, radius);
    const auto tool = sand::force::Contour::sphere(radius);
    const double middle = kCells / 2.0 * radius / kPerRadius;
    sand::force::ForceModel model(scene.force);
    sand::force::Response response;
    // A model that works between two surfaces may need some ticks until it uses the first one fully.
    for (int tick = 0; tick < 200; ++tick) {
        response = model.at(patch, 1, tool, {middle, middle, 0}, tick * ForceLimits::kTick);
    }
    return {response.stiffness, response.drag, norm(response.push)};
}

double ForceLimits::sampledAt(double seconds) const { return arm.damping / (seconds / 2 + arm.delayTicks * kTick); }

double ForceLimits::stiffnessAt(double seconds) const {
    const double sampled = sampledAt(seconds);
    const double half = std::min(arm.maxStiffness, sampled) / 2;
    if (!(arm.friction < half * resolution / 2)) {
        return half;
    }
    // A weight that rests between two steps of the encoder feels a relay that switches a force of K times one step. The
    // relay chatters at an amplitude at which it is as stiff as the limit: 2 K step/π divided by that limit. It
    // chatters at the limit's frequency.
    const double quiet = kRest * std::numbers::pi / 2 * std::sqrt(sampled * arm.mass) / resolution;
    return std::min(half, kQuiet * quiet);
}

double ForceLimits::heldSeconds(double age) const {
    return heldSteps > 0 ? heldSteps * std::max(stepSeconds, age) : kTick;
}

double ForceLimits::shareForStepOf(double age) const {
    if (!(heldSteps > 0) || !(stiffness > 0)) {
        return 1;
    }
    return std::isfinite(age) ? std::min(stiffnessAt(heldSeconds(age)) / stiffness, 1.0) : 0;
}

ForceLimits ForceLimits::of(const ArmPhysics& arm, double scale, const LawAtRadius& law, double internalFriction,
                            double probeStep, const StepTiming& steps) {
    ForceLimits limits;
    limits.arm = arm;
    limits.scale = scale;
    limits.resolution = arm.resolution + probeStep;
    limits.stepSeconds = 1 / steps.perSecond;
    limits.heldSteps = steps.between == sand::Between::hold ? 1 : steps.between == sand::Between::interpolate ? 3 : 0;
    limits.stiffness = limits.stiffnessAt(limits.heldSeconds(0));
    // A damper is stable while B < m divided by the age of the velocity, or while B is slightly larger. The longest
    // window has the oldest velocity.
    limits.damping = arm.mass / (kTick / 2 + arm.delayTicks * kTick + VelocityWindow::kLongest * kTick / 2);
    limits.internalFriction = internalFriction;
    limits.maxForce = arm.maxForce;
    const double asked = law.stiffness * scale;
    if (std::isfinite(asked)) {
        limits.gain = asked > limits.stiffness ? limits.stiffness / asked : 1;
        limits.lawStiffness = limits.gain * asked;
    } else {
        limits.gain = 0;  // no device bears such a law, and a slew limit that is not a number would limit nothing
    }
    limits.slew = limits.lawStiffness * kFastestHand * kTick;
    return limits;
}

/// Returns the reason for the limit of stiffness.
std::string ForceLimits::reason() const {
    const double held = heldSeconds(0), sampled = sampledAt(held);
    if (stiffness < std::min(arm.maxStiffness, sampled) / 2) {
        return fmt::format("at which it rests despite its encoder's step of {:g} um", 1e6 * arm.resolution);
    }
    if (arm.maxStiffness <= sampled) {
        return "half of what its maker allows";
    }
    const std::string step =
        heldSteps > 0
            ? fmt::format(", {} of {:.3g} ms", heldSteps > 1 ? "an interpolation over steps" : "a force held for steps",
                          1e3 * stepSeconds)
            : std::string();
    return fmt::format("half of what {:g} N s/m of damping{} and {} tick{} of delay allow", arm.damping, step,
                       arm.delayTicks, arm.delayTicks == 1 ? "" : "s");
}

std::vector<std::string> ForceLimits::inWords(const std::string& name, double constant, const LawAtRadius& law) const {
    const double drag = gain * law.drag * scale / 60;
    return {
        fmt::format(
            "{} {:g} {}: {} at {:.3g} scene units per metre; the law asks for {:.4g} N/m, the limit is {:.3g} N/m, {}",
            name, constant, gain < 1 ? fmt::format("→ {:g}", rounded(gain * constant)) : "as it is", arm.name, scale,
            law.stiffness * scale, stiffness, reason()),
        fmt::format("friction {:g} N s/m at one radius' depth, at most {:g} N s/m and {:g} of the push; at most "
                    "{:g} N, growing by at most {:g} N per tick",
                    rounded(drag), rounded(damping), rounded(internalFriction), maxForce, rounded(slew))};
}

}  // namespace haptic_bridge
