// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/dual.hpp"
#include "sand/force/force_constants.hpp"
#include "sand/force/vec3.hpp"

namespace sand::force {

/// Response of the sand at one place. It does not contain a velocity, because the device decides which friction is
/// stable.
struct Response {
    Vec3 push;             // force of the place alone [N]
    Vec3 normal{0, 0, 1};  // unit vector; friction acts across it
    double drag = 0;       // [N · frame/scene unit]; a frame is 1/60 s
    double stiffness = 0;  // steepest change of `push` here [N/scene unit]
    FrictionDirection direction = FrictionDirection::tangential;
};

/// Returns the part of `velocity` that friction acts against. It is the part across the normal, except for the literal
/// choices.
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
/// Returns push and friction at a velocity [scene unit/frame] by the law. A device may not bear that force.
[[nodiscard]] inline Vec3 lawfulForce(const Response& felt, Vec3 velocity) {
    return felt.push - felt.drag * rubbing(felt, velocity);
}

/// Returns the steepness of a force [N/scene unit]: the Frobenius norm of its Jacobian. The force changes by at most
/// that much in any direction. The bound is exact if the force changes along one direction only, as on level sand.
[[nodiscard]] inline double steepness(const Dual& x, const Dual& y, const Dual& z) {
    return std::sqrt(dot(x.slope, x.slope) + dot(y.slope, y.slope) + dot(z.slope, z.slope));
}

}  // namespace sand::force
