// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/force_constants.hpp"
#include "sand/force/gauges.hpp"
#include "sand/force/response.hpp"
#include "sand/force/surface_patch.hpp"
#include "sand/force/vec3.hpp"

/// What the hand feels. Forces read the sand and never change it; they may use libm.
namespace sand::force {

/// Depth and slope of the sand in the ring from one to two reaches around the tool, for the law of Dorjgotov et al.
/// 2007. The tool has pushed aside the sand under it.
struct Contact {
    Dual depth;           // [scene unit] of the tool's lowest point under the ring's mean height; below 0 over it
    Dual slopeX, slopeY;  // of the ring's plane
    double share = 0;     // of the ring that lies over the field, 0 to 1

    [[nodiscard]] Gauges gauges() const { return {4, {depth, slopeX, slopeY, {share, {}}}}; }
    explicit Contact(const Gauges& gauges)
        : depth(gauges.dials[0]), slopeX(gauges.dials[1]), slopeY(gauges.dials[2]), share(gauges.dials[3].value) {}
    Contact() = default;
};
[[nodiscard]] Contact measureContact(const SurfacePatch& patch, Vec3 centre /* [scene unit] */, const Contour& tool);

/// Returns the force of Dorjgotov et al. 2007, section 3: the push |F_r| = k_s (e^(k_c d) − 1) along a normal, and the
/// friction k_f k_a v |F_r|. The normal turns from the surface's at depth 0 to the vertical at depth R. Equation 1 is
/// printed without its bracket. The force is not bounded.
[[nodiscard]] Response contactForce(const ForceConstants& constants, const Contour& tool, const Contact& contact);

inline constexpr double kDeviceLimit = 3.3;     // [N], of a Touch
inline constexpr double kStaleSurface = 0.050;  // [s]

/// What may be sent to a device: nothing that is no number, nothing from a surface older than kStaleSurface, and at
/// most `limit` newtons, shortened without turning.
[[nodiscard]] Vec3 guarded(Vec3 force, double surfaceAge /* [s] */, double limit = kDeviceLimit);

}  // namespace sand::force
