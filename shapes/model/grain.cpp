// SPDX-License-Identifier: Apache-2.0
#include "shapes/model/grain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace shapes {
namespace {

constexpr int kMask = kGrainSide - 1;
static_assert((kGrainSide & kMask) == 0, "the pattern wraps by masking");
constexpr std::size_t kChannels = 4;
constexpr std::size_t kGrains = 2;  // the first two channels: colours and relief

/// Returns a hash of a lattice point, 0 … 255, by the finaliser of MurmurHash3 for 32 bits.
int hashAt(int x, int y, std::uint32_t seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1U + static_cast<std::uint32_t>(y) * 0x85ebca6bU + seed;
    h = (h ^ (h >> 16)) * 0x85ebca6bU;
    h = (h ^ (h >> 13)) * 0xc2b2ae35U;
    return static_cast<int>((h ^ (h >> 16)) & 0xffU);
}

/// Returns the height of the grains at a texel, 0 … 4080: white noise, smoothed by a small binomial filter.
int bump(int x, int y) {
    constexpr std::array<int, 3> kWeight{1, 2, 1};
    int sum = 0;
    for (std::size_t j = 0; j < kWeight.size(); ++j) {
        for (std::size_t i = 0; i < kWeight.size(); ++i) {
            const int dx = static_cast<int>(i) - 1, dy = static_cast<int>(j) - 1;
            sum += kWeight[i] * kWeight[j] * hashAt((x + dx) & kMask, (y + dy) & kMask, 1);
        }
    }
    return sum;
}

/// Returns bilinear noise with features of `size` texels, 0 … 255.
int slowNoise(int x, int y, int size, std::uint32_t seed) {
    const int lattice = kGrainSide / size;
    const auto at = [&](int i, int j) { return hashAt(i & (lattice - 1), j & (lattice - 1), seed); };
    const int i = x / size;
    const int j = y / size;
    const int tx = x % size;
    const int ty = y % size;
    const int south = at(i, j) * (size - tx) + at(i + 1, j) * tx;
    const int north = at(i, j + 1) * (size - tx) + at(i + 1, j + 1) * tx;
    return (south * (size - ty) + north * ty) / (size * size);
}

std::uint8_t toByte(int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); }

/// Returns the next mip level, with half the side. Each RGBA texel is the mean of four.
std::vector<float> halved(const std::vector<float>& texels, std::size_t side) {
    std::vector<float> half;
    half.reserve(texels.size() / 4);
    for (std::size_t y = 0; y < side; y += 2) {
        for (std::size_t x = 0; x < side; x += 2) {
            const auto at = [&](std::size_t i, std::size_t j, std::size_t channel) {
                return texels[((y + j) * side + x + i) * kChannels + channel];
            };
            for (std::size_t channel = 0; channel < kChannels; ++channel) {
                half.push_back((at(0, 0, channel) + at(1, 0, channel) + at(0, 1, channel) + at(1, 1, channel)) / 4);
            }
        }
    }
    return half;
}

/// Returns the factor by which the contrast of a level's grains is raised.
///
/// GL chooses the level by the longer side of a pixel's footprint, so that the grains are too pale along the shorter
/// side. The factor was chosen by eye, so that no border shows between two levels. It stays below the contrast of a
/// picture with many more pixels (tests/render_node/look_test.cpp).
float contrastOf(int level) { return level == 0 ? 1 : 1.1F * std::pow(1.35F, static_cast<float>(level - 1)); }

/// Returns the bytes of a level, with the contrast of its grains raised.
std::vector<std::uint8_t> drawn(const std::vector<float>& texels, float contrast) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const bool grain = i % kChannels < kGrains;
        bytes.push_back(
            toByte(static_cast<int>(std::lround(grain ? 127.5F + contrast * (texels[i] - 127.5F) : texels[i]))));
    }
    return bytes;
}

}  // namespace

int mottlingAt(int column, int row) {
    // The table is computed once, because computing each value took a third of the time of a vertex.
    static const std::vector<std::uint8_t> kAll = [] {
        std::vector<std::uint8_t> all;
        for (int y = 0; y < kGrainSide; ++y) {
            for (int x = 0; x < kGrainSide; ++x) {
                const int tenth = 4 * slowNoise(x, y, 64, 11) + 3 * slowNoise(x, y, 32, 12) +
                                  2 * slowNoise(x, y, 16, 13) + slowNoise(x, y, 8, 14);
                all.push_back(toByte(tenth / 10));
            }
        }
        return all;
    }();
    return kAll[static_cast<std::size_t>((row & kMask) * kGrainSide + (column & kMask))];
}

std::vector<std::uint8_t> makeGrain(const glm::vec2& sun) {
    const float length = std::max(glm::length(sun), 1e-6F);
    const glm::vec2 towards = sun / length;
    std::vector<std::uint8_t> texels;
    texels.reserve(4UL * kGrainSide * kGrainSide);
    for (int y = 0; y < kGrainSide; ++y) {
        for (int x = 0; x < kGrainSide; ++x) {
            // The sand is quartz of many shades. One grain in 32 is a dark mineral, and one in 32 glints.
            const int kind = hashAt(x, y, 7);
            const int odd = kind < 8 ? -48 : kind > 247 ? 40 : 0;
            const int clumps = (slowNoise(x, y, 4, 5) - 128) / 10;
            texels.push_back(toByte(128 + (hashAt(x, y, 3) - 128) / 6 + odd + clumps));
            const auto east = static_cast<float>(bump(x + 1, y) - bump(x - 1, y));
            const auto north = static_cast<float>(bump(x, y + 1) - bump(x, y - 1));
            texels.push_back(toByte(128 - static_cast<int>((east * towards.x + north * towards.y) / 12)));
            texels.push_back(toByte(mottlingAt(x, y)));
            texels.push_back(255);
        }
    }
    return texels;
}

std::vector<std::vector<std::uint8_t>> grainLevels(const glm::vec2& sun) {
    const std::vector<std::uint8_t> finest = makeGrain(sun);
    std::vector<float> texels(finest.begin(), finest.end());
    std::vector<std::vector<std::uint8_t>> levels;
    for (int level = 0, side = kGrainSide; side > 0; ++level, side /= 2) {
        levels.push_back(drawn(texels, contrastOf(level)));
        texels = side > 1 ? halved(texels, static_cast<std::size_t>(side)) : texels;
    }
    return levels;
}

}  // namespace shapes
