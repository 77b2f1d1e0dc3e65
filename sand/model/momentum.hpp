// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace sand {

// Momentum is the share of the last sweep's flux that continues. It begins at 0, grows with each sweep, and stays below
// 1. Height fields and TINs use the same values.
inline constexpr int kMostDamping = 25;  // [sweep]; no pile of 64 cells or more overshoots with it
inline constexpr double kMostMomentum = 0.9;

/// Returns the damping for `sweeps` sweeps in a row [sweep]. A short run ends before anything overshoots, so that its
/// momentum may grow sooner.
constexpr int dampingOf(int sweeps) { return std::clamp(sweeps / 3, 3, kMostDamping); }

/// Returns the momentum after `n` sweeps. Every machine computes the same number, for float and for double.
template <class Real>
constexpr Real momentumAfter(int n, int damping) {
    return std::min(static_cast<Real>(n) / static_cast<Real>(n + damping), static_cast<Real>(kMostMomentum));
}

}  // namespace sand
