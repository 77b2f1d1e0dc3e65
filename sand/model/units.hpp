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

/// Returns the length of a probe unit [scene unit] on cells of side `cellSize` [scene unit].
[[nodiscard]] constexpr double probeUnit(double cellSize) { return cellSize / kProbePerCell; }

}  // namespace sand
