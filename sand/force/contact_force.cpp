// SPDX-License-Identifier: Apache-2.0
#include "sand/force/contact_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sand::force {
namespace {

constexpr int kRadii = 6, kAngles = 24;

struct Direction {
    double x, y;
};

/// Returns sample points of the ring for R = 1. They lie on circles that divide the ring into equal areas. Each circle
/// is turned against the one inside it.
const std::array<Direction, kRadii * kAngles>& ring() {
    static const auto points = [] {
        std::array<Direction, kRadii * kAngles> result{};
        for (int i = 0; i < kRadii * kAngles; ++i) {
            // The order runs to and fro across the ring, so that the way from one point to the next is short for walks.
            const int ray = i / kRadii, along = i % kRadii;
            const int circle = ray % 2 == 0 ? along : kRadii - 1 - along;
            const double radius = std::sqrt(1 + 3 * (circle + 0.5) / kRadii);
            const double angle = 2 * std::numbers::pi * (ray + static_cast<double>(circle) / kRadii) / kAngles;
            result[static_cast<std::size_t>(i)] = {radius * std::cos(angle), radius * std::sin(angle)};
        }
        return result;
    }();
    return points;
}

}  // namespace

Contact measureContact(const SurfacePatch& patch, Vec3 centre, const Contour& tool) {
    Contact contact;
    if (patch.empty() || !(tool.reach > 0)) {
        return contact;
    }
    Dual sum, momentX, momentY;
    double square = 0;
    int inside = 0;
    for (const Direction& point : ring()) {
        const double dx = tool.reach * point.x, dy = tool.reach * point.y;
        if (!patch.overField(centre.x + dx, centre.y + dy)) {
            continue;
        }
        const Dual height = patch.tangent(centre.x + dx, centre.y + dy);
        ++inside;
        sum = sum + height;
        momentX = momentX + dx * (height + -centre.z);
        momentY = momentY + dy * (height + -centre.z);
        square += dx * dx + dy * dy;
    }
    if (inside == 0) {
        return contact;
    }
    contact.share = static_cast<double>(inside) / (kRadii * kAngles);
    const Dual underside{centre.z + tool.lowest, {0, 0, 1}};
    contact.depth = (1.0 / inside) * sum - underside;
    // Least squares over a whole ring: Σdx² = Σdy² = square/2, and the mixed sums vanish. At the rim of the field they
    // do not vanish, and the force is vertical.
    if (inside == kRadii * kAngles) {
        contact.slopeX = (2 / square) * momentX;
        contact.slopeY = (2 / square) * momentY;
    }
    return contact;
}

Response contactForce(const ForceConstants& constants, const Contour& tool, const Contact& contact) {
    Response felt;
    felt.direction = constants.literal ? constants.frictionDirection : FrictionDirection::tangential;
    if (!(contact.share > 0) || !(tool.reach > 0)) {
        return felt;
    }
    const Dual t = clamped((1 / tool.reach) * contact.depth);
    const Dual upright = t * t * (3 - 2 * t);
    const Dual flat = Dual{1, {}} / sqrt(contact.slopeX * contact.slopeX + contact.slopeY * contact.slopeY + 1);
    const Dual lean = (1 - upright) * flat;
    const Dual x = lean * (0 - contact.slopeX), y = lean * (0 - contact.slopeY), z = lean + upright;
    const Dual length = sqrt(x * x + y * y + z * z);
    felt.normal = (1 / length.value) * Vec3{x.value, y.value, z.value};
    if (!(contact.depth.value > 0)) {
        return felt;
    }
    // expm1 is the bracket that the print of equation 1 lost: without it the force at depth 0 would be k_s.
    const Dual size = contact.share * constants.stiffness * expm1(constants.depthExponent * contact.depth);
    const Dual scale = size / length;
    const Dual forceX = scale * x, forceY = scale * y, forceZ = scale * z;
    felt.push = {forceX.value, forceY.value, forceZ.value};
    felt.drag = constants.friction * constants.frictionArea * size.value;
    felt.stiffness = steepness(forceX, forceY, forceZ);
    return felt;
}

Vec3 guarded(Vec3 force, double surfaceAge, double limit) {
    const double size = norm(force);
    if (!std::isfinite(size) || !(surfaceAge <= kStaleSurface)) {
        return {};
    }
    return size > limit ? (limit / size) * force : force;
}

}  // namespace sand::force
