// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pictures/image.hpp"

namespace pictures {

/// One byte per pixel, row by row from the top: 1 where it holds, else 0.
using Mask = std::vector<std::uint8_t>;

/// How two pictures of one size differ.
struct Comparison {
    int largestDifference = 0;   // [level], over all channels of all pixels
    std::int64_t badPixels = 0;  // those with a channel that differs by more than the limit
    double badShare = 0;         // of all pixels, 0 to 1
    Mask bad;
};

/// Throws base::InputError when the sizes differ.
[[nodiscard]] Comparison compare(const Image& a, const Image& b, int limit /* [level] */);

/// Returns by how much `b` is brighter than `a` in each channel, as a mean over the pixels of `where` [level]; zeros if
/// there are none. Throws std::invalid_argument when the sizes differ.
[[nodiscard]] std::array<double, kChannels> meanDifference(const Image& a, const Image& b, const Mask& where);

/// For a person: `reference` dimmed to a quarter, the bad pixels bright red.
[[nodiscard]] Image differenceImage(const Image& reference, const Comparison& comparison);

/// The silhouettes of a picture: pixels with more than `contrast` levels between the darkest and brightest of a channel
/// in their 3x3 surroundings, and the neighbours of such pixels. A rasterizer may decide these either way when the same
/// surface is drawn through another viewport; anything else that differs is a mistake.
[[nodiscard]] Mask silhouettes(const Image& reference, int contrast /* [level] */);

/// How many pixels of `bad` are not in `allowed`. Throws std::invalid_argument when the sizes differ.
[[nodiscard]] std::int64_t countOutside(const Mask& bad, const Mask& allowed);

}  // namespace pictures
