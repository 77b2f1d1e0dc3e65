// SPDX-License-Identifier: Apache-2.0
#include "pictures/stereo_packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "pictures/anaglyph.hpp"

namespace pictures {
namespace {

/// Returns both whole pictures in one, the right one at (`rightX`, `rightY`).
Image beside(const Image& left, const Image& right, int rightX, int rightY) {
    Image both(rightX + right.width, rightY + right.height);
    blit(both, left, 0, 0);
    blit(both, right, rightX, rightY);
    return both;
}

/// Returns the left picture with the pixels of the right one at all places for which fromRight(column, row) is true.
template <class FromRight>
Image interleaved(const Image& left, const Image& right, FromRight fromRight) {
    Image both = left;
    for (int y = 0; y < both.height; ++y) {
        for (int x = 0; x < both.width; ++x) {
            if (fromRight(x, y)) {
                std::copy_n(right.at(x, y), kChannels, both.at(x, y));
            }
        }
    }
    return both;
}

Image redOfLeft(const Image& left, const Image& right) {
    Image both = right;
    for (std::size_t i = 0; i < both.rgb.size(); i += kChannels) {
        both.rgb[i] = left.rgb[i];
    }
    return both;
}

Image mixed(const AnaglyphWeights& weights, const Image& left, const Image& right) {
    const auto& lights = lightOfLevel();
    const auto& levels = levelOfLight();
    Image both(left.width, left.height);
    for (std::size_t pixel = 0; pixel < both.rgb.size(); pixel += kChannels) {
        for (std::size_t to = 0; to < kChannels; ++to) {
            std::int32_t sum = 1 << (kWeightBits - 1);
            for (std::size_t from = 0; from < kChannels; ++from) {
                sum += weights.left[to][from] * lights[left.rgb[pixel + from]];
                sum += weights.right[to][from] * lights[right.rgb[pixel + from]];
            }
            const std::int32_t light = std::clamp(sum >> kWeightBits, 0, kFullLight);
            both.rgb[pixel + to] = levels[static_cast<std::size_t>(light)];
        }
    }
    return both;
}

}  // namespace

Image packStereo(walls::Stereo stereo, const Image& left, const Image& right) {
    if (left.width != right.width || left.height != right.height) {
        throw std::invalid_argument(
            fmt::format("eyes of {}x{} and {}x{} pixels", left.width, left.height, right.width, right.height));
    }
    switch (stereo) {
        case walls::Stereo::sideBySide:
            return beside(left, right, left.width, 0);
        case walls::Stereo::topBottom:
            return beside(left, right, 0, left.height);
        case walls::Stereo::rowInterlaced:
            return interleaved(left, right, [](int /* column */, int row) { return row % 2 == 1; });
        case walls::Stereo::checkerboard:
            return interleaved(left, right, [](int column, int row) { return (column + row) % 2 == 1; });
        case walls::Stereo::anaglyphColour:
            return redOfLeft(left, right);
        case walls::Stereo::anaglyphHalf:
        case walls::Stereo::anaglyphDubois:
            return mixed(anaglyphWeights(stereo), left, right);
        case walls::Stereo::mono:
        case walls::Stereo::left:
        case walls::Stereo::right:
        case walls::Stereo::passive:
        case walls::Stereo::active:
            break;
    }
    throw std::invalid_argument(fmt::format("{} shows no two eyes in one picture", walls::stereoName(stereo)));
}

}  // namespace pictures
