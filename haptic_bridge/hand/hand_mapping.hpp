// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "sand/model/mean_height.hpp"
#include "sand/model/step.hpp"
#include "sand/surface_factory.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {

/// Mapping from hand space to quantised probe points over the sand. It keeps a reference to the scene, which must
/// outlive it.
class HandMapping {
public:
    /// With Heights::atFirstUse, the first probe() unpacks the surface, which takes a second in the largest fields.
    HandMapping(const scene::Scene& scene, HandSettings::Datum datum, sand::Heights when = sand::Heights::now);

    [[nodiscard]] HandSettings::Datum datum() const { return datum_; }
    /// Returns the probe point of `pose`, clamped to sand::kMaxProbe. Returns nullopt if a coordinate is not finite.
    [[nodiscard]] std::optional<sand::ProbePoint> probe(const Pose& pose) const;
    /// Returns the heading of `pose`. Returns nullopt if the hand does not turn the tool, or if the angle is not
    /// finite.
    [[nodiscard]] static std::optional<sand::Heading> heading(const Pose& pose) {
        return pose.heading ? sand::headingOf(*pose.heading, pose.leftFoot) : std::nullopt;
    }

private:
    [[nodiscard]] double datumAt(double x, double y) const;  // [cell], height of the datum at x, y [cell]

    const scene::Scene& scene_;
    HandSettings::Datum datum_;
    double halfSide_;         // [cell], half of the shorter side
    double radius_;           // [cell], of the tool
    double reference_;        // [cell], mean height of the surface at the start
    sand::HeightAt surface_;  // surface at the start; empty unless the hand follows it
};

}  // namespace haptic_bridge
