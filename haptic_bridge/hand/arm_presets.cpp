// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/arm_presets.hpp"

#include <string>

namespace haptic_bridge {
namespace {

constexpr double kUnstated = std::numeric_limits<double>::infinity();

struct Row {
    double mass, damping, friction, resolution, maxForce, reach, maxStiffness;
};

// Masses and dampings are apparent values at the tip, in the middle of the workspace, as measured on such devices.
// Forces, resolutions, reaches and the Touch's stiffness come from the makers.
constexpr std::array<Row, kArmPresets.size()> kRows{{
    {0.045, 0.35, 0.26, 55e-6, 3.3, 0.075, 400},
    {0.13, 1.5, 0.3, 60e-6, 8, 0.04, kUnstated},
    {0.2, 2.5, 0, 10e-6, 12, 0.075, kUnstated},
    {0.25, 2.5, 0, 20e-6, 20, 0.15, kUnstated},
}};

}  // namespace

std::optional<ArmPhysics> armPreset(std::string_view name) {
    for (std::size_t i = 0; i < kRows.size(); ++i) {
        if (kArmPresets[i] == name) {
            const Row& row = kRows[i];
            return ArmPhysics{std::string(name), row.mass,         row.damping,
                              row.friction,      row.resolution,   row.maxForce,
                              row.reach,         row.maxStiffness, 1};
        }
    }
    return std::nullopt;
}

ArmPhysics touchPreset() { return *armPreset("touch"); }

}  // namespace haptic_bridge
