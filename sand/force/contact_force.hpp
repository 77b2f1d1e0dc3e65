// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/surface_patch.hpp"
#include "sand/force/vec3.hpp"
#include "sand/scene.hpp"

/// What the hand feels. Forces read the sand and never change it; they may use libm.
namespace sand::force {

/// The tool and the sand around it, reduced to what the force depends on.
struct Contact {
    double depth = 0;  // [scene unit] of the tool's lowest point under the ring around it, ≥ 0
    Vec3 normal{0, 0, 1};
    double share = 0;  // of the ring that lies over the field, 0 to 1
};

/// Measures the ring from one to two radii around the tool: its mean height and its slope. The normal turns from the
/// surface's at depth 0 to the vertical at depth R.
[[nodiscard]] Contact measureContact(const SurfacePatch& patch, Vec3 centre /* [scene unit] */, double radius);

/// First paper, section 4: |F_r| = k_s (e^(k_c d) − 1) along the normal, and friction k_f v |F_r| against the
/// tangential velocity [scene unit per 1/60 s]. Returns [N]. Not bounded; see guarded().
[[nodiscard]] Vec3 contactForce(const ForceConstants& constants, const Contact& contact, Vec3 velocity);

inline constexpr double kDeviceLimit = 3.3;     // [N], of a Touch
inline constexpr double kStaleSurface = 0.050;  // [s]

/// What may be sent to a device: nothing that is no number, nothing from a surface older than kStaleSurface, and at
/// most `limit` newtons, shortened without turning.
[[nodiscard]] Vec3 guarded(Vec3 force, double surfaceAge /* [s] */, double limit = kDeviceLimit);

}  // namespace sand::force
