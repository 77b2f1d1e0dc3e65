// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>
#include <cmath>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// Positive when `d` lies within the circle through a, b, c, which run counter-clockwise; zero on it. Exact.
///
/// Within a field of 2^22 probe units a side, minors and squares fit 2^46 and the whole fits 2^94: integers of 128 bits
/// decide what doubles cannot.
[[nodiscard]] inline int inCircle(const Place& a, const Place& b, const Place& c, const Place& d) {
    const std::int64_t ax = a.x - d.x, ay = a.y - d.y;
    const std::int64_t bx = b.x - d.x, by = b.y - d.y;
    const std::int64_t cx = c.x - d.x, cy = c.y - d.y;
    const std::int64_t a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    const std::int64_t bc = bx * cy - by * cx, ca = cx * ay - cy * ax, ab = ax * by - ay * bx;
    const double u = static_cast<double>(a2) * static_cast<double>(bc);
    const double v = static_cast<double>(b2) * static_cast<double>(ca);
    const double w = static_cast<double>(c2) * static_cast<double>(ab);
    const double sum = u + v + w;
    // All factors are exact: three products and two sums round, each by 2^-53 of at most the sum of magnitudes.
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

/// Whether the edge b–c between the triangles a, b, c and d, c, b has to give way to a–d.
///
/// Of four on a circle, the diagonal goes out from the first in order of Place. That is as if every vertex were lowered
/// on the paraboloid a little, the first by far the most: no four are on a circle then, the mesh is unique, and flips
/// reach it from any other.
[[nodiscard]] inline bool mustFlip(const Place& a, const Place& b, const Place& c, const Place& d) {
    const int inside = inCircle(a, b, c, d);
    return inside > 0 || (inside == 0 && std::min(a, d) < std::min(b, c));
}

}  // namespace sand::tin
