// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

inline constexpr int kGrainSide = 256;         // [texel]
inline constexpr double kGrainTexel = 0.0006;  // [m], room: about the pixel of a wall

/// RGBA of a square of sand that repeats seamlessly, row by row: shade of the grains' own colours, shade of their
/// relief under a sun that stands in this direction (both with mean 1/2), slow noise, nothing. From an integer hash:
/// the same on every machine but for a rounding of the relief.
[[nodiscard]] std::vector<std::uint8_t> makeGrain(const glm::vec2& sun /* east, north */);

/// Slow change of the sand's shade from place to place, 0 … 255, which repeats after 256 cells.
[[nodiscard]] int mottlingAt(int column, int row);

/// makeGrain() in GL, with its mip levels.
class GrainTexture {
public:
    explicit GrainTexture(const glm::vec2& sun /* east, north */);
    /// For the sampler of this texture unit.
    void bind(int unit) const;

private:
    GlTexture texture_;
};

}  // namespace render_node
