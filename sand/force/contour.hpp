// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "sand/force/vec3.hpp"

namespace sand::force {

/// The outline of the tool as forces use it, turned to the present heading. Its points are the control points of
/// Purchart et al. 2012, relative to the tool's centre.
struct Contour {
    static constexpr int kPoints = 32;
    std::array<Vec3, kPoints> points{};  // on the outline, counter-clockwise; z is the underside there [scene unit]
    double reach = 0;   // largest horizontal distance of a control point from the centre [scene unit]; 0: no tool
    double lowest = 0;  // lowest point of the underside [scene unit], ≤ 0

    /// Returns the contour of a sphere, the tool of Dorjgotov et al. 2007. Its points lie on a circle of `radius`,
    /// level with the sphere's lowest point.
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
