// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace shapes {

inline constexpr int kGrainSide = 256;         // [texel]
inline constexpr double kGrainTexel = 0.0006;  // [m] in the room, about the size of a wall's pixel

/// Returns the RGBA texels of a square of sand that repeats without seams, row by row.
///
/// The channels are: shade of the grains' colours, shade of the grains' relief, slow noise, and 255. The relief is lit
/// by a sun in direction `sun`. Both shades have the mean 1/2. All values come from an integer hash, so that all
/// machines agree except for rounding of the relief.
[[nodiscard]] std::vector<std::uint8_t> makeGrain(const glm::vec2& sun /* east, north */);

/// Returns the slow change of the sand's shade from place to place, 0 … 255. It repeats after 256 cells.
[[nodiscard]] int mottlingAt(int column, int row);

/// Returns the texels of makeGrain() and of its mip levels, each with half the side of the one before. The contrast of
/// the grains rises from level to level.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> grainLevels(const glm::vec2& sun /* east, north */);

}  // namespace shapes
