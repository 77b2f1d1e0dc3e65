// SPDX-License-Identifier: Apache-2.0
#include "pictures/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "base/input_error.hpp"

namespace pictures {
namespace {

/// Combines each pixel with its eight neighbours, or with fewer at the rim, one channel at a time. It combines rows
/// first, then columns: six combinations per pixel instead of nine.
template <class Combine>
std::vector<std::uint8_t> over3x3(const std::vector<std::uint8_t>& values, int width, int height, int channels,
                                  Combine combine) {
    const auto row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    const auto step = static_cast<std::size_t>(channels);
    const auto rows = static_cast<std::size_t>(height);
    // Not a copy, because g++ 14 warns by mistake that its size may be too large.
    std::vector<std::uint8_t> across(values.begin(), values.end());
    for (std::size_t y = 0; y < rows; ++y) {
        const std::size_t start = y * row;
        for (std::size_t i = step; i < row; ++i) {
            across[start + i] = combine(across[start + i], values[start + i - step]);
            across[start + i - step] = combine(across[start + i - step], values[start + i]);
        }
    }
    std::vector<std::uint8_t> result = across;
    for (std::size_t y = 1; y < rows; ++y) {
        for (std::size_t i = y * row; i < (y + 1) * row; ++i) {
            result[i] = combine(result[i], across[i - row]);
            result[i - row] = combine(result[i - row], across[i]);
        }
    }
    return result;
}

constexpr auto kLarger = [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); };
constexpr auto kSmaller = [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); };

}  // namespace

Comparison compare(const Image& a, const Image& b, int limit) {
    if (a.width != b.width || a.height != b.height) {
        throw base::InputError(
            fmt::format("pictures of {}x{} and {}x{} pixels cannot be compared", a.width, a.height, b.width, b.height));
    }
    Comparison result;
    result.bad.assign(a.pixels(), 0);
    for (std::size_t pixel = 0; pixel < a.pixels(); ++pixel) {
        int largest = 0;
        for (std::size_t channel = pixel * kChannels; channel < (pixel + 1) * kChannels; ++channel) {
            largest = std::max(largest, std::abs(int{a.rgb[channel]} - int{b.rgb[channel]}));
        }
        result.largestDifference = std::max(result.largestDifference, largest);
        if (largest > limit) {
            result.bad[pixel] = 1;
            ++result.badPixels;
        }
    }
    if (!result.bad.empty()) {
        result.badShare = static_cast<double>(result.badPixels) / static_cast<double>(result.bad.size());
    }
    return result;
}

std::array<double, kChannels> meanDifference(const Image& a, const Image& b, const Mask& where) {
    if (a.width != b.width || a.height != b.height || where.size() != a.pixels()) {
        throw std::invalid_argument(fmt::format("pictures of {}x{} and {}x{} pixels with a mask of {}", a.width,
                                                a.height, b.width, b.height, where.size()));
    }
    std::array<std::int64_t, kChannels> sums{};
    std::int64_t count = 0;
    for (std::size_t pixel = 0; pixel < where.size(); ++pixel) {
        for (std::size_t channel = 0; channel < kChannels && where[pixel] != 0; ++channel) {
            const std::size_t at = pixel * kChannels + channel;
            sums.at(channel) += int{b.rgb[at]} - int{a.rgb[at]};
        }
        count += where[pixel] != 0 ? 1 : 0;
    }
    std::array<double, kChannels> means{};
    for (std::size_t channel = 0; channel < kChannels && count > 0; ++channel) {
        means.at(channel) = static_cast<double>(sums.at(channel)) / static_cast<double>(count);
    }
    return means;
}

Image differenceImage(const Image& reference, const Comparison& comparison) {
    Image image = reference;
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel) {
        std::uint8_t* colour = &image.rgb[pixel * kChannels];
        for (int channel = 0; channel < kChannels; ++channel) {
            colour[channel] = static_cast<std::uint8_t>(colour[channel] / 4);
        }
        if (comparison.bad.at(pixel) != 0) {
            colour[0] = 255;
        }
    }
    return image;
}

Mask silhouettes(const Image& reference, int contrast) {
    const auto brightest = over3x3(reference.rgb, reference.width, reference.height, kChannels, kLarger);
    const auto darkest = over3x3(reference.rgb, reference.width, reference.height, kChannels, kSmaller);
    Mask edges(reference.pixels(), 0);
    for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
        if (brightest[i] - darkest[i] > contrast) {
            edges[i / kChannels] = 1;
        }
    }
    return over3x3(edges, reference.width, reference.height, 1, kLarger);
}

std::int64_t countOutside(const Mask& bad, const Mask& allowed) {
    if (bad.size() != allowed.size()) {
        throw std::invalid_argument(fmt::format("masks of {} and {} pixels", bad.size(), allowed.size()));
    }
    std::int64_t count = 0;
    for (std::size_t i = 0; i < bad.size(); ++i) {
        count += bad[i] != 0 && allowed[i] == 0 ? 1 : 0;
    }
    return count;
}

}  // namespace pictures
