// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

inline constexpr int kGrainSide = 256;         // [texel]
inline constexpr double kGrainTexel = 0.0008;  // [m], room: about the pixel of a wall

/// RGBA of a square of sand that repeats seamlessly, row by row: brightness of the grains, their slopes east and north
/// (all with mean 1/2), and slow mottling. The same on every machine: an integer hash and integer sums.
[[nodiscard]] std::vector<std::uint8_t> makeGrain();

/// makeGrain() in GL, with its mip levels.
class GrainTexture {
public:
    GrainTexture();
    /// For the sampler of this texture unit.
    void bind(int unit) const;

private:
    GlTexture texture_;
};

}  // namespace render_node
