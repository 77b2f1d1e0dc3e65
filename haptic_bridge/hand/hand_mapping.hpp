// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "sand/model/step.hpp"
#include "sand/model/surface.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

/// Puts a hand over the sand: hand space to quantised probe points. Reads the scene, which must outlive it.
class HandMapping {
public:
    HandMapping(const scene::Scene& scene, HandSettings::Datum datum);

    [[nodiscard]] HandSettings::Datum datum() const { return datum_; }
    /// Poses beyond reach are clamped to sand::kMaxProbe. A pose that holds no number gives nothing.
    [[nodiscard]] std::optional<sand::ProbePoint> probe(const Pose& pose) const;
    /// Nothing for a hand that does not turn the tool, or turns it by what is no number.
    [[nodiscard]] static std::optional<sand::Heading> heading(const Pose& pose) {
        return pose.heading ? sand::headingOf(*pose.heading, pose.leftFoot) : std::nullopt;
    }
    /// The tool's centre [scene unit], from the south-west corner and from height 0.
    [[nodiscard]] sand::force::Vec3 place(sand::ProbePoint at) const;

private:
    [[nodiscard]] double surface(double x, double y) const;  // [cell]

    const scene::Scene& scene_;
    HandSettings::Datum datum_;
    double halfSide_;                           // [cell], of the shorter side
    double radius_;                             // [cell]
    double reference_;                          // [cell]
    std::shared_ptr<const sand::Surface> tin_;  // as the scene starts; null unless the hand follows a TIN
};

}  // namespace haptic_bridge
