// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace sand {

// How much of the last sweep's flux goes on: it begins without, grows, and stays below 1, on a grid and on a TIN.
inline constexpr int kMostDamping = 25;  // [sweep], what overshoots no pile of 64 cells or more
inline constexpr double kMostMomentum = 0.9;

/// Of so many sweeps in a row: few end before anything overshoots, and may gather momentum sooner.
constexpr int dampingOf(int sweeps) { return std::clamp(sweeps / 3, 3, kMostDamping); }

/// After n sweeps of something, the same for every machine in either type.
template <class Real>
constexpr Real momentumAfter(int n, int damping) {
    return std::min(static_cast<Real>(n) / static_cast<Real>(n + damping), static_cast<Real>(kMostMomentum));
}

}  // namespace sand
