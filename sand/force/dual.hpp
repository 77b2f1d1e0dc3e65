// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "sand/force/vec3.hpp"

namespace sand::force {

/// Dual number: a value, and its gradient over the place of the tool. Arithmetic computes both (forward
/// differentiation), so that a law written once also gives its Jacobian.
struct Dual {
    double value = 0;
    Vec3 slope;  // gradient [unit of the value / scene unit]
};
[[nodiscard]] inline Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.slope + b.slope}; }
[[nodiscard]] inline Dual operator+(Dual a, double b) { return {a.value + b, a.slope}; }
[[nodiscard]] inline Dual operator-(double a, Dual b) { return {a - b.value, -1 * b.slope}; }
[[nodiscard]] inline Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.slope - b.slope}; }
[[nodiscard]] inline Dual operator*(double a, Dual b) { return {a * b.value, a * b.slope}; }
[[nodiscard]] inline Dual operator*(Dual a, Dual b) {
    return {a.value * b.value, b.value * a.slope + a.value * b.slope};
}
[[nodiscard]] inline Dual operator/(Dual a, Dual b) {
    const double quotient = a.value / b.value;
    return {quotient, (1 / b.value) * (a.slope - quotient * b.slope)};
}
[[nodiscard]] inline Dual sqrt(Dual a) {
    const double root = std::sqrt(a.value);
    return {root, (0.5 / root) * a.slope};
}
[[nodiscard]] inline Dual expm1(Dual a) { return {std::expm1(a.value), std::exp(a.value) * a.slope}; }
/// Returns `a` clamped to [0, 1]. The gradient is 0 outside.
[[nodiscard]] inline Dual clamped(Dual a) { return a.value <= 0 ? Dual{} : a.value >= 1 ? Dual{1, {}} : a; }

}  // namespace sand::force
