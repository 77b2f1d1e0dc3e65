// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sand {

inline constexpr int kMaxSide = 16384;               // [cell], longest side of a field
inline constexpr std::int32_t kMaxHeight = 1 << 28;  // [unit], largest magnitude of a height
inline constexpr int kHeightBits = 16;               // one height unit is cellSize / 2^16
inline constexpr int kProbeBits = 8;                 // one probe unit is cellSize / 2^8
inline constexpr std::int32_t kUnitsPerCell = 1 << kHeightBits;
inline constexpr std::int32_t kProbePerCell = 1 << kProbeBits;
inline constexpr std::int32_t kUnitsPerProbe = kUnitsPerCell / kProbePerCell;

// Fluxes are rounded to one unit, so that slopes change by up to 4 units. A projection therefore aims below the talus
// by this share of it. If the slope were exactly the talus, the whole slope would creep. With this allowance, a pile at
// 512² rests after 18 sweeps instead of 1100.
inline constexpr double kTalusSlack = 1.0 / 16384;

/// Returns the length of a probe unit [scene unit] on cells of side `cellSize` [scene unit].
[[nodiscard]] constexpr double probeUnit(double cellSize) { return cellSize / kProbePerCell; }

}  // namespace sand
