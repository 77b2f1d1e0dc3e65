// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/guards/force_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "haptic_bridge/guards/velocity_window.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {

LawAtRadius lawAtRadius(const sand::Scene& scene) {
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
    // A model that works between two surfaces may take a while to trust the first.
    for (int tick = 0; tick < 1000; ++tick) {
        response = model.at(patch, 1, tool, {middle, middle, 0}, tick * ForceLimits::kTick);
    }
    return {response.stiffness, response.drag, norm(response.push)};
}

ForceLimits ForceLimits::of(const ArmPhysics& arm, double scale, const LawAtRadius& law, double internalFriction,
                            double probeStep) {
    ForceLimits limits;
    limits.arm = arm;
    limits.scale = scale;
    const double delay = arm.delayTicks * kTick;
    limits.stiffness = std::min(arm.maxStiffness, arm.damping / (kTick / 2 + delay)) / 2;
    // A damper is stable while B < m over the age of the velocity, or somewhat more; the longest window is the oldest.
    limits.damping = arm.mass / (kTick / 2 + delay + VelocityWindow::kLongest * kTick / 2);
    limits.internalFriction = internalFriction;
    limits.maxForce = arm.maxForce;
    const double asked = law.stiffness * scale;
    limits.gain = asked > limits.stiffness ? limits.stiffness / asked : 1;
    limits.lawStiffness = limits.gain * asked;
    limits.slew = limits.lawStiffness * kFastestHand * kTick;
    limits.resolution = arm.resolution + probeStep;
    return limits;
}

std::vector<std::string> ForceLimits::inWords(const std::string& name, double constant, const LawAtRadius& law) const {
    const double asked = law.stiffness * scale;
    const std::string device = fmt::format("{:.3g} scene units per metre of {}", scale, arm.name);
    const std::string bears = fmt::format("{:.3g} N/m, half of what {}", stiffness,
                                          2 * stiffness < arm.maxStiffness
                                              ? fmt::format("{:.3g} N s/m of damping and {} tick{} of delay bear",
                                                            arm.damping, arm.delayTicks, arm.delayTicks == 1 ? "" : "s")
                                              : std::string("its maker allows"));
    const std::string first = gain < 1
                                  ? fmt::format("{} {:.3g} → {:.2g}: at {} it asks for {:.4g} N/m, and is given {}",
                                                name, constant, gain * constant, device, asked, bears)
                                  : fmt::format("{} {:.3g} as it is: at {} it asks for {:.3g} N/m, and may ask for {}",
                                                name, constant, device, asked, bears);
    const double drag = gain * law.drag * scale / 60;
    return {first,
            fmt::format("friction {:.2g} N s/m at one radius' depth, at most {:.2g} N s/m and {:.2g} of the push; "
                        "at most {:.3g} N, growing by at most {:.2g} N a tick",
                        drag, damping, internalFriction, maxForce, slew)};
}

}  // namespace haptic_bridge
