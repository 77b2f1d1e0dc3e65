// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>
#include <cmath>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// Returns 1 if `d` lies within the circle through a, b and c, 0 if it lies on the circle, and -1 if it lies outside.
/// a, b and c must run counter-clockwise. Exact.
///
/// The sides of a field are at most 2^22 probe units. Minors and squares then stay within 2^46, and the whole within
/// 2^94. 128-bit integers decide if doubles cannot.
[[nodiscard]] inline int inCircle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                                  const LatticePoint& d) {
    const std::int64_t ax = a.x - d.x, ay = a.y - d.y;
    const std::int64_t bx = b.x - d.x, by = b.y - d.y;
    const std::int64_t cx = c.x - d.x, cy = c.y - d.y;
    const std::int64_t a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    const std::int64_t bc = bx * cy - by * cx, ca = cx * ay - cy * ax, ab = ax * by - ay * bx;
    const double u = static_cast<double>(a2) * static_cast<double>(bc);
    const double v = static_cast<double>(b2) * static_cast<double>(ca);
    const double w = static_cast<double>(c2) * static_cast<double>(ab);
    const double sum = u + v + w;
    // All factors are exact. Three products and two sums round, each by at most 2^-53 of the sum of magnitudes.
    const double error = (std::abs(u) + std::abs(v) + std::abs(w)) * 0x1p-50;
    if (sum > error) {
        return 1;
    }
    if (sum < -error) {
        return -1;
    }
    const Wide exact = static_cast<Wide>(a2) * bc + static_cast<Wide>(b2) * ca + static_cast<Wide>(c2) * ab;
    return exact > 0 ? 1 : exact < 0 ? -1 : 0;
}

/// Returns whether the edge b–c between the triangles a, b, c and d, c, b must be flipped to a–d.
///
/// If all four lie on a circle, the diagonal begins at the first of them in the order of LatticePoint. This is as if
/// every vertex were lowered a little on the paraboloid, the first one by far the most. Then no four vertices are on a
/// circle, the mesh is unique, and flips lead to it from every other mesh.
[[nodiscard]] inline bool mustFlip(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                                   const LatticePoint& d) {
    const int inside = inCircle(a, b, c, d);
    return inside > 0 || (inside == 0 && std::min(a, d) < std::min(b, c));
}

}  // namespace sand::tin
