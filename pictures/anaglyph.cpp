// SPDX-License-Identifier: Apache-2.0
#include "pictures/anaglyph.hpp"

#include <cmath>
#include <stdexcept>

namespace pictures {
namespace {

constexpr std::int32_t weight(double share) {
    const double scaled = share * (1 << kWeightBits);
    return static_cast<std::int32_t>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
}

constexpr std::array<std::int32_t, 3> weights(double red, double green, double blue) {
    return {weight(red), weight(green), weight(blue)};
}

constexpr AnaglyphWeights kColour{{weights(1, 0, 0), weights(0, 0, 0), weights(0, 0, 0)},
                                  {weights(0, 0, 0), weights(0, 1, 0), weights(0, 0, 1)}};
constexpr AnaglyphWeights kHalf{{weights(0.2126, 0.7152, 0.0722), weights(0, 0, 0), weights(0, 0, 0)}, kColour.right};
constexpr AnaglyphWeights kDubois{{weights(0.456100, 0.500484, 0.176381), weights(-0.0400822, -0.0378246, -0.0157589),
                                   weights(-0.0152161, -0.0205971, -0.00546856)},
                                  {weights(-0.0434706, -0.0879388, -0.00155529), weights(0.378476, 0.73364, -0.0184503),
                                   weights(-0.0721527, -0.112961, 1.2264)}};

double lightOf(double level) {
    const double share = level / 255;
    return kFullLight * (share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4));
}

std::vector<std::uint8_t> makeLevels() {
    std::vector<std::uint8_t> levels(kFullLight + 1);
    int level = 0;
    for (int light = 0; light <= kFullLight; ++light) {
        // The nearest level is the one that is nearest in sRGB levels. The border between two levels is the light of
        // half a level.
        while (level < 255 && light >= lightOf(level + 0.5)) {
            ++level;
        }
        levels[static_cast<std::size_t>(light)] = static_cast<std::uint8_t>(level);
    }
    return levels;
}

std::array<std::uint16_t, 256> makeLights() {
    std::array<std::uint16_t, 256> lights{};
    for (std::size_t level = 0; level < lights.size(); ++level) {
        lights[level] = static_cast<std::uint16_t>(std::lround(lightOf(static_cast<double>(level))));
    }
    return lights;
}

}  // namespace

const AnaglyphWeights& anaglyphWeights(walls::Stereo stereo) {
    switch (stereo) {
        case walls::Stereo::anaglyphColour:
            return kColour;
        case walls::Stereo::anaglyphHalf:
            return kHalf;
        case walls::Stereo::anaglyphDubois:
            return kDubois;
        default:
            throw std::invalid_argument(std::string(walls::stereoName(stereo)) + " is not an anaglyph mode");
    }
}

const std::array<std::uint16_t, 256>& lightOfLevel() {
    static const std::array<std::uint16_t, 256> lights = makeLights();
    return lights;
}

const std::vector<std::uint8_t>& levelOfLight() {
    static const std::vector<std::uint8_t> levels = makeLevels();
    return levels;
}

}  // namespace pictures
