// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/hand_mapping.hpp"

#include <algorithm>
#include <cmath>

#include "sand/surface_factory.hpp"

namespace haptic_bridge {

HandMapping::HandMapping(const scene::Scene& scene, HandSettings::Datum datum, sand::Heights when)
    : scene_(scene),
      datum_(datum),
      halfSide_(std::min(scene.rules.columns, scene.rules.rows) / 2.0),
      radius_(static_cast<double>(scene.rules.tuning.tool.radius) / sand::kProbePerCell),
      reference_(static_cast<double>(scene.referenceHeight()) / sand::kUnitsPerCell) {
    if (datum_ != HandSettings::Datum::level) {
        surface_ = sand::startHeights(scene, when);
    }
}

double HandMapping::datumAt(double x, double y) const {
    constexpr int kSamples = 9;  // across and along the tool
    return datum_ == HandSettings::Datum::level
               ? reference_
               : sand::meanHeight(surface_, x * sand::kProbePerCell, y * sand::kProbePerCell,
                                  scene_.rules.tuning.tool.radius, kSamples) /
                     sand::kUnitsPerCell;
}

std::optional<sand::ProbePoint> HandMapping::probe(const Pose& pose) const {
    if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.z)) {
        return std::nullopt;
    }
    const double x = scene_.rules.columns / 2.0 + pose.x * halfSide_;
    const double y = scene_.rules.rows / 2.0 + pose.y * halfSide_;
    return sand::probePoint(x, y, datumAt(x, y) + pose.z * radius_);
}

}  // namespace haptic_bridge
