// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "walls/wall.hpp"

/// Numbers of red-cyan anaglyphs. The reference on the CPU and the shader of a render rank read the same integer
/// tables. So their results are equal bit for bit. All functions are pure. Any thread may call them.
namespace pictures {

inline constexpr int kFullLight = 65535;  // linear light of sRGB level 255
inline constexpr int kWeightBits = 14;

/// Weights of each channel of an eye in each channel of the anaglyph [2^-14, linear light]: left[to][from], red first.
/// A sum is rounded to the nearest number and clamped to [0, kFullLight].
struct AnaglyphWeights {
    std::array<std::array<std::int32_t, 3>, 3> left{}, right{};
};

/// Returns the weights of a mode. Throws std::invalid_argument if `stereo` is not an anaglyph mode.
///
/// anaglyphColour: each channel comes from one channel of one eye. anaglyphHalf: red is the left eye's luminance (Rec.
/// 709: 0.2126, 0.7152, 0.0722), green and blue are the right eye's. anaglyphDubois: the least-squares projection of E.
/// Dubois, "A projection method to generate anaglyph stereo images" (ICASSP 2001), for red-cyan glasses and a CRT. Its
/// numbers are those of W. Sanders and D. F. McAllister, "Producing anaglyphs from synthetic images" (SPIE 5006, 2003),
/// scaled so that white stays white.
[[nodiscard]] const AnaglyphWeights& anaglyphWeights(walls::Stereo stereo);

/// Returns the linear light of each sRGB level, 0 to kFullLight.
[[nodiscard]] const std::array<std::uint16_t, 256>& lightOfLevel();
/// Returns the nearest sRGB level of each amount of light from 0 to kFullLight. It is the inverse of lightOfLevel().
[[nodiscard]] const std::vector<std::uint8_t>& levelOfLight();

}  // namespace pictures
