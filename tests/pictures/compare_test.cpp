// SPDX-License-Identifier: Apache-2.0
#include "pictures/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>

#include "base/input_error.hpp"
#include "pictures/png_file.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/run_program.hpp"
#include "tests/support/seed.hpp"

namespace pictures {
namespace {

/// Returns a bright square from (10, 10) to (19, 19) on dark ground.
Image square() {
    Image image(30, 30);
    std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{40});
    for (int y = 10; y < 20; ++y) {
        std::fill_n(image.at(10, y), 10 * kChannels, std::uint8_t{200});
    }
    return image;
}

TEST(Compare, CountsPixelsBeyondTheLimitAndNotAtIt) {
    const Image a = square();
    Image b = a;
    b.at(3, 4)[1] = 40 + 8;  // at the limit: not bad
    b.at(5, 6)[2] = 40 - 9;  // one level beyond the limit
    b.at(15, 15)[0] = 255;   // two channels of one pixel count once
    b.at(15, 15)[1] = 0;
    const Comparison comparison = compare(a, b, 8);
    EXPECT_EQ(comparison.largestDifference, 200);
    EXPECT_EQ(comparison.badPixels, 2);
    EXPECT_DOUBLE_EQ(comparison.badShare, 2.0 / 900);
    EXPECT_EQ(comparison.bad[6 * 30 + 5], 1);
    EXPECT_EQ(comparison.bad[4 * 30 + 3], 0);
    const Image shown = differenceImage(a, comparison);
    EXPECT_EQ(shown.at(5, 6)[0], 255);
    EXPECT_EQ(shown.at(4, 6)[0], 10);
}

TEST(Compare, LooksAtTheFirstAndTheLastPixel) {
    const Image a = square();
    for (const int corner : {0, 29}) {
        Image b = a;
        b.at(corner, corner)[2] = 90;
        const Comparison comparison = compare(a, b, 8);
        EXPECT_EQ(comparison.largestDifference, 50) << corner;
        EXPECT_EQ(comparison.badPixels, 1) << corner;
    }
}

TEST(Compare, FindsNoDifferenceBetweenAPictureAndItself) {
    const Comparison comparison = compare(square(), square(), 0);
    EXPECT_EQ(comparison.largestDifference, 0);
    EXPECT_EQ(comparison.badPixels, 0);
}

TEST(Compare, RefusesPicturesOfDifferentSizes) {
    EXPECT_THROW((void)compare(Image(3, 4), Image(4, 3), 8), base::InputError);
}

TEST(Compare, TellsByHowMuchAPictureIsBrighterInTheMean) {
    const Image a = square();
    Image b = a;
    Mask ground(a.pixels(), 1);  // all pixels except the square's 100
    for (int y = 10; y < 20; ++y) {
        for (int x = 10; x < 20; ++x) {
            ground[static_cast<std::size_t>(y * 30 + x)] = 0;
            b.at(x, y)[1] = 250;
        }
    }
    b.at(3, 4)[0] = 40 + 80;
    b.at(5, 6)[2] = 40 - 40;
    using Means = std::array<double, kChannels>;
    EXPECT_EQ(meanDifference(a, b, ground), (Means{80.0 / 800, 0, -40.0 / 800}));
    EXPECT_EQ(meanDifference(a, b, Mask(a.pixels(), 1)), (Means{80.0 / 900, 50.0 * 100 / 900, -40.0 / 900}));
    EXPECT_EQ(meanDifference(a, b, Mask(a.pixels(), 0)), Means{});
    EXPECT_THROW((void)meanDifference(a, Image(30, 29), ground), std::invalid_argument);
    EXPECT_THROW((void)meanDifference(a, b, Mask(a.pixels() - 1, 1)), std::invalid_argument);
}

TEST(Silhouettes, AreTheEdgeOfTheSquareTwoPixelsToEitherSide) {
    const Mask mask = silhouettes(square(), 32);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 30; ++x) {
            // The 3x3 surroundings reach one pixel over the edge, and their neighbours one more pixel.
            const bool near = x >= 8 && x < 22 && y >= 8 && y < 22;
            const bool inside = x >= 12 && x < 18 && y >= 12 && y < 18;
            EXPECT_EQ(mask[static_cast<std::size_t>(y * 30 + x)], near && !inside ? 1 : 0) << x << "," << y;
        }
    }
    EXPECT_EQ(std::count(mask.begin(), mask.end(), 1), 14 * 14 - 6 * 6);
    const Mask none = silhouettes(square(), 160);
    EXPECT_EQ(std::count(none.begin(), none.end(), 1), 0) << "a contrast of 160 is not above 160";
}

TEST(Silhouettes, EqualTheirDefinitionOnRandomPictures) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const int width = 1 + static_cast<int>(random() % 12);
    const int height = 1 + static_cast<int>(random() % 12);
    Image image(width, height);
    std::generate(image.rgb.begin(), image.rgb.end(), [&] { return static_cast<std::uint8_t>(random() % 90); });
    const auto inside = [&](int x, int y) { return x >= 0 && y >= 0 && x < width && y < height; };
    const auto edge = [&](int x, int y) {
        int contrast = 0;
        for (int channel = 0; channel < kChannels; ++channel) {
            int low = 255, high = 0;
            for (int v = y - 1; v <= y + 1; ++v) {
                for (int u = x - 1; u <= x + 1; ++u) {
                    if (inside(u, v)) {
                        low = std::min<int>(low, image.at(u, v)[channel]);
                        high = std::max<int>(high, image.at(u, v)[channel]);
                    }
                }
            }
            contrast = std::max(contrast, high - low);
        }
        return contrast > 80;
    };
    const Mask mask = silhouettes(image, 80);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            bool expected = false;
            for (int i = 0; i < 9; ++i) {
                const int u = x - 1 + i % 3, v = y - 1 + i / 3;
                expected = expected || (inside(u, v) && edge(u, v));
            }
            EXPECT_EQ(mask[static_cast<std::size_t>(y * width + x)] != 0, expected) << x << "," << y;
        }
    }
}

TEST(Silhouettes, ExcuseAWobblingEdgeButNoSpotInTheOpen) {
    const Image reference = square();
    Image other = reference;
    other.at(10, 15)[0] = other.at(10, 15)[1] = other.at(10, 15)[2] = 40;  // the edge is one pixel further here
    const Mask edges = silhouettes(reference, 32);
    EXPECT_EQ(countOutside(compare(reference, other, 8).bad, edges), 0);
    other.at(15, 15)[0] = 100;
    EXPECT_EQ(countOutside(compare(reference, other, 8).bad, edges), 1);
}

class CompareProgram : public test::FolderTest {
protected:
    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    support::Ran run(const std::string& arguments) { return support::runProgram("sandwall-compare", arguments); }
};

TEST_F(CompareProgram, ExitsWithZeroForAlikeAndOneForDifferent) {
    const Image a = square();
    Image b = a;
    b.at(1, 1)[0] = 140;
    writePng(path("a.png"), a);
    writePng(path("b.png"), b);
    const support::Ran alike = run(path("a.png") + " " + path("b.png"));
    EXPECT_EQ(alike.status, 0) << alike.output;
    EXPECT_NE(alike.output.find("difference: 100"), std::string::npos) << alike.output;
    EXPECT_NE(alike.output.find("0.001111 (1 of 900)"), std::string::npos) << alike.output;
    EXPECT_EQ(run(path("a.png") + " " + path("b.png") + " --max-bad-share 0.001").status, 1);
    EXPECT_EQ(run(path("a.png") + " " + path("b.png") + " --max-bad-share 0 --max-channel-diff 100").status, 0);
    EXPECT_EQ(run(path("a.png") + " " + path("b.png") + " --max-bad-share 0 --diff " + path("d.png")).status, 1);
    EXPECT_EQ(readPng(path("d.png")).at(1, 1)[0], 255);
}

TEST_F(CompareProgram, ExitsWithTwoAndOneLineForWhatItCannotUse) {
    writePng(path("a.png"), square());
    writePng(path("small.png"), Image(2, 2));
    for (const std::string& arguments :
         {path("a.png") + " " + path("none.png"), path("a.png") + " " + path("small.png"), path("a.png"),
          std::string("--what"), path("a.png") + " " + path("a.png") + " --max-bad-share 2",
          path("a.png") + " " + path("a.png") + " --diff " + path("no/such/folder.png"),
          path("a.png") + " " + folder_.string()}) {
        const support::Ran ran = run(arguments);
        EXPECT_EQ(ran.status, 2) << arguments;
        EXPECT_EQ(ran.output.find("largest") == std::string::npos
                      ? std::count(ran.output.begin(), ran.output.end(), '\n')
                      : std::count(ran.output.begin(), ran.output.end(), '\n') - 2,
                  1)
            << ran.output;
    }
}

}  // namespace
}  // namespace pictures
