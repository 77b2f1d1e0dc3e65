// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/force_constants.hpp"
#include "sand/force/gauges.hpp"
#include "sand/force/response.hpp"
#include "sand/force/surface_patch.hpp"
#include "sand/force/vec3.hpp"

/// Forces that the hand feels. They read the sand and never change it. They may use libm.
namespace sand::force {

/// Depth and slope of the sand in the ring from one to two reaches around the tool, for the law of Dorjgotov et al.
/// 2007. The tool has pushed aside the sand under it.
struct Contact {
    Dual depth;  // depth of the tool's lowest point below the ring's mean height [scene unit]; negative above it
    Dual slopeX, slopeY;  // slope of the ring's plane
    double share = 0;     // share of the ring that lies over the field, 0 to 1

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

inline constexpr double kDeviceLimit = 3.3;     // largest force of a Touch [N]
inline constexpr double kStaleSurface = 0.050;  // age from which a surface gives no force [s]

/// Returns the force that may be sent to a device. It is 0 if `force` is not finite or if the surface is older than
/// kStaleSurface. A force above `limit` [N] is shortened to it and keeps its direction.
[[nodiscard]] Vec3 guarded(Vec3 force, double surfaceAge /* [s] */, double limit = kDeviceLimit);

}  // namespace sand::force
