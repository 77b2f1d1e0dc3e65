// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pictures/image.hpp"

namespace pictures {

/// Mask of a picture: one byte per pixel, row by row from the top, 1 for pixels in the mask and 0 for others.
using Mask = std::vector<std::uint8_t>;

/// Difference between two pictures of one size.
struct Comparison {
    int largestDifference = 0;   // [level], over all channels of all pixels
    std::int64_t badPixels = 0;  // pixels with a channel that differs by more than the limit
    double badShare = 0;         // share of all pixels, 0 to 1
    Mask bad;
};

/// Compares two pictures. Throws base::InputError if their sizes differ.
[[nodiscard]] Comparison compare(const Image& a, const Image& b, int limit /* [level] */);

/// Returns the mean difference `b` - `a` of each channel over the pixels of `where` [level]. Returns zeros if `where`
/// has no pixels. Throws std::invalid_argument if the sizes differ.
[[nodiscard]] std::array<double, kChannels> meanDifference(const Image& a, const Image& b, const Mask& where);

/// Returns a picture for a person: `reference` dimmed to a quarter, with the bad pixels in bright red.
[[nodiscard]] Image differenceImage(const Image& reference, const Comparison& comparison);

/// Returns the silhouettes of a picture. They are the pixels in whose 3×3 surroundings a channel differs by more than
/// `contrast`, and the neighbours of these pixels. A rasteriser may draw these pixels either way when it draws the same
/// surface through another viewport. A difference at any other pixel is a mistake.
[[nodiscard]] Mask silhouettes(const Image& reference, int contrast /* [level] */);

/// Returns the number of pixels of `bad` that are not in `allowed`. Throws std::invalid_argument if the sizes differ.
[[nodiscard]] std::int64_t countOutside(const Mask& bad, const Mask& allowed);

}  // namespace pictures
