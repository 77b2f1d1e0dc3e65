// SPDX-License-Identifier: Apache-2.0
#include "pictures/stereo_packing.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "pictures/anaglyph.hpp"

namespace pictures {
namespace {

using walls::Stereo;

/// Returns a picture in which every pixel has a different colour. The two eyes share no colour.
Image eye(int width, int height, int blue) {
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y)[0] = static_cast<std::uint8_t>(20 + 7 * x);
            image.at(x, y)[1] = static_cast<std::uint8_t>(30 + 11 * y);
            image.at(x, y)[2] = static_cast<std::uint8_t>(blue);
        }
    }
    return image;
}

Image grey(int level) {
    Image image(1, 1);
    image.rgb.assign(3, static_cast<std::uint8_t>(level));
    return image;
}

TEST(StereoPacking, SideBySideHasTheLeftEyeOnTheLeft) {
    const Image left = eye(5, 3, 10), right = eye(5, 3, 90);
    const Image both = packStereo(Stereo::sideBySide, left, right);
    ASSERT_EQ(both.width, 10);
    EXPECT_EQ(crop(both, 0, 0, 5, 3), left);
    EXPECT_EQ(crop(both, 5, 0, 5, 3), right);
}

TEST(StereoPacking, TopBottomHasTheLeftEyeAbove) {
    const Image left = eye(5, 3, 10), right = eye(5, 3, 90);
    const Image both = packStereo(Stereo::topBottom, left, right);
    ASSERT_EQ(both.height, 6);
    EXPECT_EQ(crop(both, 0, 0, 5, 3), left);
    EXPECT_EQ(crop(both, 0, 3, 5, 3), right);
}

TEST(StereoPacking, InterlacedRowsBeginWithTheLeftEyeAtTheTop) {
    const Image left = eye(4, 5, 10), right = eye(4, 5, 90);
    const Image both = packStereo(Stereo::rowInterlaced, left, right);
    for (int row = 0; row < 5; ++row) {
        EXPECT_EQ(crop(both, 0, row, 4, 1), crop(row % 2 == 0 ? left : right, 0, row, 4, 1)) << "row " << row;
    }
}

TEST(StereoPacking, CheckerboardBeginsWithTheLeftEyeAtTheTopLeft) {
    const Image left = eye(5, 3, 10), right = eye(5, 3, 90);
    const Image both = packStereo(Stereo::checkerboard, left, right);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 5; ++column) {
            const Image& from = (row + column) % 2 == 0 ? left : right;
            EXPECT_EQ(crop(both, column, row, 1, 1), crop(from, column, row, 1, 1)) << column << ", " << row;
        }
    }
}

TEST(StereoPacking, AColourAnaglyphIsRedForTheLeftEyeAndCyanForTheRight) {
    const Image left = eye(3, 2, 10), right = shifted(left, 1, 0);
    const Image both = packStereo(Stereo::anaglyphColour, left, right);
    for (std::size_t i = 0; i < both.rgb.size(); ++i) {
        EXPECT_EQ(both.rgb[i], i % 3 == 0 ? left.rgb[i] : right.rgb[i]);
    }
    EXPECT_NE(both, packStereo(Stereo::anaglyphColour, right, left));
}

TEST(StereoPacking, AHalfColourAnaglyphShowsTheLeftEyesLuminanceAsRed) {
    Image left(1, 1), right(1, 1);
    left.rgb = {200, 100, 50};
    right.rgb = {9, 120, 210};
    const auto light = [](int level) { return std::pow((level / 255.0 + 0.055) / 1.055, 2.4); };
    const double luminance = 0.2126 * light(200) + 0.7152 * light(100) + 0.0722 * light(50);
    const double red = 255 * (1.055 * std::pow(luminance, 1 / 2.4) - 0.055);
    const Image both = packStereo(Stereo::anaglyphHalf, left, right);
    EXPECT_EQ(both.rgb, (std::vector<std::uint8_t>{static_cast<std::uint8_t>(std::lround(red)), 120, 210}));
}

TEST(StereoPacking, GreyStaysGreyInEveryAnaglyph) {
    for (int level = 0; level < 256; ++level) {
        EXPECT_EQ(packStereo(Stereo::anaglyphColour, grey(level), grey(level)), grey(level));
        EXPECT_EQ(packStereo(Stereo::anaglyphHalf, grey(level), grey(level)), grey(level));
        const Image dubois = packStereo(Stereo::anaglyphDubois, grey(level), grey(level));
        for (const std::uint8_t channel : dubois.rgb) {
            EXPECT_EQ(channel, level);  // rows of the matrices sum to 1 within 1e-5
        }
    }
}

TEST(StereoPacking, DuboisKeepsEachEyeBehindItsFilter) {
    const auto luminance = [](const Image& left, const Image& right) {
        return packStereo(Stereo::anaglyphDubois, left, right).rgb;
    };
    const auto onlyLeft = luminance(grey(200), grey(0));
    EXPECT_GT(onlyLeft[0], 200);  // the weight is 1.13
    EXPECT_EQ(onlyLeft[1], 0);    // a negative amount of light is clamped to black
    EXPECT_EQ(onlyLeft[2], 0);
    const auto onlyRight = luminance(grey(0), grey(200));
    EXPECT_EQ(onlyRight[0], 0);
    EXPECT_GT(onlyRight[1], 200);
    EXPECT_GT(onlyRight[2], 200);
}

// The matrices solve a least-squares problem. The test solves it with the measured spectra: XYZ of each phosphor, bare
// and behind each filter (Sanders and McAllister 2003), columns red, green, blue.
TEST(StereoPacking, DuboisMatricesAreTheLeastSquaresProjection) {
    const auto rows = [](glm::dvec3 x, glm::dvec3 y, glm::dvec3 z) { return glm::transpose(glm::dmat3(x, y, z)); };
    const glm::dmat3 bare = rows({11.6638, 8.3959, 4.65843}, {7.10807, 16.6845, 2.45008}, {0.527874, 3.79124, 24.0604});
    const glm::dmat3 red =
        rows({5.42327, 0.807004, 0.047325}, {2.70972, 0.50201, 0.0250529}, {0.0000550941, 0.000411221, 0.00240686});
    const glm::dmat3 cyan = rows({0.180431, 1.6395, 2.00309}, {0.448214, 6.31551, 1.35757}, {0.289201, 2.3925, 11.062});
    const glm::dmat3 inverse = glm::inverse(glm::transpose(red) * red + glm::transpose(cyan) * cyan);
    const glm::dmat3 left = inverse * glm::transpose(red) * bare, right = inverse * glm::transpose(cyan) * bare;
    const AnaglyphWeights& weights = anaglyphWeights(Stereo::anaglyphDubois);
    for (int to = 0; to < 3; ++to) {
        double white = 0;
        for (int from = 0; from < 3; ++from) {
            white += left[from][to] + right[from][to];
        }
        for (int from = 0; from < 3; ++from) {
            const auto i = static_cast<std::size_t>(to), j = static_cast<std::size_t>(from);
            EXPECT_NEAR(weights.left[i][j] / 16384.0, left[from][to] / white, 4e-5) << to << from;
            EXPECT_NEAR(weights.right[i][j] / 16384.0, right[from][to] / white, 4e-5) << to << from;
        }
    }
}

TEST(StereoPacking, LightAndLevelsUndoEachOther) {
    for (std::size_t level = 0; level < 256; ++level) {
        EXPECT_EQ(levelOfLight().at(lightOfLevel()[level]), level);
    }
    EXPECT_EQ(lightOfLevel()[255], kFullLight);
    EXPECT_EQ(levelOfLight().size(), 65536U);
}

TEST(StereoPacking, RefusesUnequalEyesAndModesOfOneEye) {
    EXPECT_THROW((void)packStereo(Stereo::anaglyphColour, Image(3, 2), Image(2, 3)), std::invalid_argument);
    for (const Stereo one : {Stereo::mono, Stereo::left, Stereo::right, Stereo::passive, Stereo::active}) {
        EXPECT_THROW((void)packStereo(one, Image(3, 2), Image(3, 2)), std::invalid_argument);
    }
}

}  // namespace
}  // namespace pictures
