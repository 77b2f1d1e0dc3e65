// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/hand_mapping.hpp"

#include <algorithm>
#include <cmath>

#include "sand/surface_factory.hpp"

namespace haptic_bridge {

HandMapping::HandMapping(const scene::Scene& scene, HandSettings::Datum datum)
    : scene_(scene),
      datum_(datum),
      halfSide_(std::min(scene.rules.columns, scene.rules.rows) / 2.0),
      radius_(static_cast<double>(scene.rules.tuning.tool.radius) / sand::kProbePerCell),
      reference_(static_cast<double>(scene.referenceHeight()) / sand::kUnitsPerCell) {
    if (datum_ != HandSettings::Datum::level && scene.tin != nullptr) {
        tin_ = sand::makeSurface(scene);
    }
}

double HandMapping::surface(double x, double y) const {
    if (datum_ == HandSettings::Datum::level) {
        return reference_;
    }
    // Averages nine by nine places under the tool, because ripples smaller than the tool must not shake the hand.
    const sand::HeightField& field = scene_.terrain;
    constexpr int kHalf = 4;
    double sum = 0;
    for (int j = -kHalf; j <= kHalf; ++j) {
        for (int i = -kHalf; i <= kHalf; ++i) {
            if (tin_ != nullptr) {
                sum += tin_->height((x + radius_ * i / kHalf) * sand::kProbePerCell,
                                    (y + radius_ * j / kHalf) * sand::kProbePerCell);
                continue;
            }
            const double across = std::clamp(x + radius_ * i / kHalf, 0.5, field.columns() - 0.5) - 0.5;
            const double along = std::clamp(y + radius_ * j / kHalf, 0.5, field.rows() - 0.5) - 0.5;
            const int column = std::min(static_cast<int>(across), field.columns() - 1);
            const int row = std::min(static_cast<int>(along), field.rows() - 1);
            const int east = std::min(column + 1, field.columns() - 1), north = std::min(row + 1, field.rows() - 1);
            const double u = across - column, v = along - row;
            sum += (1 - v) * ((1 - u) * field.height(column, row) + u * field.height(east, row)) +
                   v * ((1 - u) * field.height(column, north) + u * field.height(east, north));
        }
    }
    return sum / ((2 * kHalf + 1) * (2 * kHalf + 1)) / sand::kUnitsPerCell;
}

std::optional<sand::ProbePoint> HandMapping::probe(const Pose& pose) const {
    if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.z)) {
        return std::nullopt;
    }
    const double x = scene_.rules.columns / 2.0 + pose.x * halfSide_;
    const double y = scene_.rules.rows / 2.0 + pose.y * halfSide_;
    const double z = surface(x, y) + pose.z * radius_;
    const auto quantised = [](double cells) {
        constexpr double kFarthest = sand::kMaxProbe;
        return static_cast<std::int32_t>(
            std::floor(std::clamp(cells * sand::kProbePerCell, -kFarthest, kFarthest - 1) + 0.5));
    };
    return sand::ProbePoint{quantised(x), quantised(y), quantised(z)};
}

sand::force::Vec3 HandMapping::place(sand::ProbePoint at) const {
    const double unit = scene_.terrain.cellSize() / sand::kProbePerCell;
    return {at.x * unit, at.y * unit, at.z * unit};
}

}  // namespace haptic_bridge
