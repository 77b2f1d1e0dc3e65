// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "sand/force/vec3.hpp"

namespace sand::force {

/// The tool as forces know it, turned as it is now: the second paper's control points, around its centre.
struct Contour {
    static constexpr int kPoints = 32;
    std::array<Vec3, kPoints> points{};  // [scene unit] on the outline, counter-clockwise; z is the underside's there
    double reach = 0;                    // [scene unit], of the farthest of them in the plane; 0: no tool
    double lowest = 0;                   // [scene unit], of the underside, ≤ 0

    /// The first paper's sphere, whose control points lie on its equator's shadow at the height of its lowest point.
    [[nodiscard]] static Contour sphere(double radius /* [scene unit] */) {
        Contour contour{{}, radius, -radius};
        for (int i = 0; i < kPoints; ++i) {
            const double angle = 2 * std::numbers::pi * i / kPoints;
            contour.points[static_cast<std::size_t>(i)] = {radius * std::cos(angle), radius * std::sin(angle), -radius};
        }
        return contour;
    }
};

}  // namespace sand::force
