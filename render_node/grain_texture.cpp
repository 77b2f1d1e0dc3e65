// SPDX-License-Identifier: Apache-2.0
#include "render_node/grain_texture.hpp"

#include <algorithm>
#include <array>

#include "render_node/gl/compiler_memory.hpp"

namespace render_node {
namespace {

constexpr int kMask = kGrainSide - 1;
static_assert((kGrainSide & kMask) == 0, "the pattern wraps by masking");

/// 0 … 255 per lattice point (the finaliser of MurmurHash3 on 32 bits).
int hashAt(int x, int y, std::uint32_t seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1U + static_cast<std::uint32_t>(y) * 0x85ebca6bU + seed;
    h = (h ^ (h >> 16)) * 0x85ebca6bU;
    h = (h ^ (h >> 13)) * 0xc2b2ae35U;
    return static_cast<int>((h ^ (h >> 16)) & 0xffU);
}

/// How high the grains lie at a texel, 0 … 4080: white noise under a small binomial blur.
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

/// Bilinear noise with features of `size` texels, 0 … 255.
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

}  // namespace

int mottlingAt(int column, int row) {
    // Computing it took a third of the time of a vertex.
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
            // Quartz of many shades; one grain in 32 is a dark mineral, one in 32 glints.
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

GrainTexture::GrainTexture(const glm::vec2& sun) {
    const std::vector<std::uint8_t> texels = makeGrain(sun);
    glBindTexture(GL_TEXTURE_2D, texture_.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kGrainSide, kGrainSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    giveBackCompilerMemory();  // software drivers do it by shaders
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    // Levels are chosen for the axis along which sand is seen most foreshortened: half a level less keeps grains across
    // it, and still fewer than a finer picture would show (tests/render_node/look_test.cpp).
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_LOD_BIAS, -0.5F);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void GrainTexture::bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture_.id());
}

}  // namespace render_node
