// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/tool_keys.hpp"

#include <algorithm>
#include <cmath>

namespace haptic_bridge {
namespace {

constexpr double kWider = 1.25;    // ratio of the tool's sizes after and before a notch
constexpr double kShortest = 2;    // [cell], length of the tool
constexpr double kLongest = 0.25;  // length of the tool over the field's shorter side

}  // namespace

ToolLimits ToolLimits::of(const scene::Scene& scene) {
    const double cell = scene.terrain.cellSize();
    const double side = std::min(scene.rules.columns, scene.rules.rows) * cell;
    const double least = kShortest * cell / 2;
    const double most = std::min(kLongest * side / 2, double{sand::kLargestToolRadius} / sand::kProbePerCell * cell);
    const double usual = scene::usualToolRadius(scene.rules.columns, scene.rules.rows, cell);
    return {least, std::max(least, most), usual};
}

double ToolLimits::resized(double radius, double notches) const {
    const double wanted = radius * std::pow(kWider, notches);
    return notches > 0 ? std::clamp(wanted, least, std::max(most, radius))
                       : std::clamp(wanted, std::min(least, radius), most);
}

double deepened(double depth, double notches) {
    return std::clamp(depth + kDepthPerNotch * notches, kShallowest, kDeepest);
}

double turned(double heading, double degrees) {
    const double sum = std::fmod(heading + degrees, 360);
    return sum < 0 ? sum + 360 : sum;
}

double moistened(double humidity, double more) {
    return std::clamp(std::round((humidity + more) * 1000) / 1000, 0.0, 1.0);
}

}  // namespace haptic_bridge
