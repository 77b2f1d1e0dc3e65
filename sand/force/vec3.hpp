// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "sand/model/probe_point.hpp"

namespace sand::force {

struct Vec3 {
    double x = 0, y = 0, z = 0;
};
[[nodiscard]] inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
[[nodiscard]] inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
[[nodiscard]] inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
[[nodiscard]] inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
/// Returns `a` with its direction and a norm of at most `most`.
[[nodiscard]] inline Vec3 shortened(Vec3 a, double most) {
    const double size = norm(a);
    return size > most ? (most / size) * a : a;
}
/// Returns the place of `probe` [scene unit], measured from the south-west corner and from height 0. `unit` is the
/// length of a probe unit.
[[nodiscard]] inline Vec3 placeOf(const ProbePoint& probe, double unit) {
    return {probe.x * unit, probe.y * unit, probe.z * unit};
}

}  // namespace sand::force
