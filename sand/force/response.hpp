// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/dual.hpp"
#include "sand/force/force_constants.hpp"
#include "sand/force/vec3.hpp"

namespace sand::force {

/// What the sand answers at one place. The velocity comes in last, because what of it is stable depends on the device.
struct Response {
    Vec3 push;             // [N], of the place alone
    Vec3 normal{0, 0, 1};  // unit; friction is across it
    double drag = 0;       // [N · frame/scene unit], a frame being 1/60 s
    double stiffness = 0;  // [N/scene unit], the steepest that push is here
    FrictionDirection direction = FrictionDirection::tangential;
};

/// The part of a velocity that friction is against: across the normal, but for the literal choices.
[[nodiscard]] inline Vec3 rubbing(const Response& felt, Vec3 velocity) {
    switch (felt.direction) {
        case FrictionDirection::full:
            return velocity;
        case FrictionDirection::vertical:
            return {0, 0, velocity.z};
        default:
            return velocity - dot(velocity, felt.normal) * felt.normal;
    }
}
/// Push and friction at a velocity [scene unit/frame], as the law says: not limited to what a device can bear.
[[nodiscard]] inline Vec3 lawfulForce(const Response& felt, Vec3 velocity) {
    return felt.push - felt.drag * rubbing(felt, velocity);
}

/// The steepest that a force is: at most this many newtons per scene unit in any direction, and exactly that many where
/// it changes along one direction only, as on level sand (Frobenius' norm of the Jacobian).
[[nodiscard]] inline double steepness(const Dual& x, const Dual& y, const Dual& z) {
    return std::sqrt(dot(x.slope, x.slope) + dot(y.slope, y.slope) + dot(z.slope, z.slope));
}

}  // namespace sand::force
