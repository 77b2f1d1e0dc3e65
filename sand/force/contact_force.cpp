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

/// Sample points of the ring for R = 1: circles that halve equal areas, each turned against the one inside it.
const std::array<Direction, kRadii * kAngles>& ring() {
    static const auto points = [] {
        std::array<Direction, kRadii * kAngles> result{};
        for (int i = 0; i < kRadii * kAngles; ++i) {
            const int circle = i / kAngles;
            const double radius = std::sqrt(1 + 3 * (circle + 0.5) / kRadii);
            const double angle = 2 * std::numbers::pi * (i % kAngles + static_cast<double>(circle) / kRadii) / kAngles;
            result[static_cast<std::size_t>(i)] = {radius * std::cos(angle), radius * std::sin(angle)};
        }
        return result;
    }();
    return points;
}

}  // namespace

Contact measureContact(const SurfacePatch& patch, Vec3 centre, double radius) {
    Contact contact;
    if (patch.empty() || !(radius > 0)) {
        return contact;
    }
    double sum = 0, momentX = 0, momentY = 0, square = 0;
    int inside = 0;
    for (const Direction& point : ring()) {
        const double dx = radius * point.x, dy = radius * point.y;
        if (!patch.overField(centre.x + dx, centre.y + dy)) {
            continue;
        }
        const double height = patch.height(centre.x + dx, centre.y + dy);
        ++inside;
        sum += height;
        momentX += (height - centre.z) * dx;
        momentY += (height - centre.z) * dy;
        square += dx * dx + dy * dy;
    }
    if (inside == 0) {
        return contact;
    }
    contact.share = static_cast<double>(inside) / (kRadii * kAngles);
    contact.depth = std::max(0.0, sum / inside - (centre.z - radius));
    // Least squares over a whole ring: Σdx² = Σdy² = square/2, the mixed sums vanish. Over the rim they do not, and the
    // force there is vertical.
    const bool whole = inside == kRadii * kAngles;
    const double slopeX = whole ? 2 * momentX / square : 0, slopeY = whole ? 2 * momentY / square : 0;
    const double flat = 1 / std::sqrt(1 + slopeX * slopeX + slopeY * slopeY);
    const double t = std::clamp(contact.depth / radius, 0.0, 1.0);
    const double upright = t * t * (3 - 2 * t);
    const Vec3 surface{-slopeX * flat, -slopeY * flat, flat};
    const Vec3 blend = (1 - upright) * surface + upright * Vec3{0, 0, 1};
    contact.normal = (1 / norm(blend)) * blend;
    return contact;
}

Vec3 contactForce(const ForceConstants& constants, const Contact& contact, Vec3 velocity) {
    // expm1 is the bracket that the paper's print lost: without it the force at depth 0 would be k_s.
    const double push = contact.share * constants.stiffness * std::expm1(constants.depthExponent * contact.depth);
    const Vec3 tangential = velocity - dot(velocity, contact.normal) * contact.normal;
    return push * contact.normal - (constants.friction * push) * tangential;
}

Vec3 guarded(Vec3 force, double surfaceAge, double limit) {
    const double size = norm(force);
    if (!std::isfinite(size) || !(surfaceAge <= kStaleSurface)) {
        return {};
    }
    return size > limit ? (limit / size) * force : force;
}

}  // namespace sand::force
