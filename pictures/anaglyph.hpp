// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "walls/wall.hpp"

/// What a red-cyan anaglyph is made of, in whole numbers: the reference on the CPU and the shader of a render rank
/// read the same tables, and come out alike to the bit. Pure functions, safe from any thread.
namespace pictures {

inline constexpr int kFullLight = 65535;  // what sRGB level 255 emits
inline constexpr int kWeightBits = 14;

/// How much of each channel of an eye goes into each channel of the anaglyph [2^-14, linear light]:
/// left[to][from], red first. A sum is rounded to the nearest and held between 0 and kFullLight.
struct AnaglyphWeights {
    std::array<std::array<std::int32_t, 3>, 3> left{}, right{};
};

/// anaglyphHalf: red is the left eye's luminance (Rec. 709: 0.2126, 0.7152, 0.0722), green and blue are the right
/// eye's. anaglyphDubois: the least-squares projection of E. Dubois, "A projection method to generate anaglyph stereo
/// images" (ICASSP 2001), for red-cyan glasses and a CRT; the numbers are those of W. Sanders and D. F. McAllister,
/// "Producing anaglyphs from synthetic images" (SPIE 5006, 2003), scaled so that white stays white. anaglyphColour: one
/// channel to one. Throws std::invalid_argument for any other mode.
[[nodiscard]] const AnaglyphWeights& anaglyphWeights(walls::Stereo stereo);

/// Linear light of each sRGB level, 0 to kFullLight: gamma is taken off here, before the weights, ...
[[nodiscard]] const std::array<std::uint16_t, 256>& lightOfLevel();
/// ... and put on again here: the nearest sRGB level of each amount of light, kFullLight + 1 of them.
[[nodiscard]] const std::vector<std::uint8_t>& levelOfLight();

}  // namespace pictures
