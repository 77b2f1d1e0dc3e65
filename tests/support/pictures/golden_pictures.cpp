// SPDX-License-Identifier: Apache-2.0
#include "tests/support/pictures/golden_pictures.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "pictures/png_file.hpp"

namespace golden {

std::filesystem::path failures() { return std::filesystem::path(SANDWALL_BIN_DIR).parent_path() / "golden_failures"; }

namespace {

using pictures::Image;
using pictures::Mask;

constexpr int kLevels = 8;
// llvmpipe gives the same pixels with vectors of any width. Another version of llvmpipe, or another processor, may draw
// a silhouette differently or round a grain the other way. softpipe, another renderer, differs in at most 13 of 86,400
// pixels. In one picture it differs along a rim, a row of 233 pixels.
constexpr double kMostBad = 0.005;
// Largest difference of a channel's mean [level]. Roundings go both ways: softpipe is at most 0.07 levels off, and 0.09
// levels in the tool's part. A processor without SSE4.1 truncates levels instead of rounding them, and is 0.4 to 0.9
// levels darker.
constexpr double kMostMean = 0.25;

constexpr const char* kHow =
    "look at the picture; if it is right: SANDWALL_WRITE_GOLDENS=1 bin/render_node_tests --gtest_filter='Golden*'";

bool writesGoldens() {
    const char* wish = std::getenv("SANDWALL_WRITE_GOLDENS");
    return wish != nullptr && std::string(wish) == "1";
}

const std::filesystem::path kFailures = failures();

/// Writes the file "got". If there is a golden picture, also writes "want" and "diff".
void leave(const std::string& name, const Image& got, const Image* expected, const Image* difference) {
    std::filesystem::create_directories(kFailures);
    pictures::writePng(kFailures / (name + ".got.png"), got);
    if (expected != nullptr) {
        pictures::writePng(kFailures / (name + ".want.png"), *expected);
    }
    if (difference != nullptr) {
        pictures::writePng(kFailures / (name + ".diff.png"), *difference);
    }
}

/// Returns the limit that the pixels of `where` exceed, or an empty text.
std::string faultWithin(const std::string& what, const Mask& where, const Image& expected, const Image& got,
                        const pictures::Comparison& comparison) {
    const auto pixels = static_cast<double>(std::count(where.begin(), where.end(), 1));
    Mask elsewhere = where;
    std::ranges::transform(where, elsewhere.begin(), [](auto inside) { return inside == 0 ? 1 : 0; });
    const auto bad = static_cast<double>(pictures::countOutside(comparison.bad, elsewhere));
    if (bad > kMostBad * pixels) {
        return fmt::format("of the {} pixels of {}, {} differ by more than {} levels, the most by {}", pixels, what,
                           bad, kLevels, comparison.largestDifference);
    }
    const auto means = pictures::meanDifference(expected, got, where);
    if (std::ranges::any_of(means, [](double mean) { return std::abs(mean) > kMostMean; })) {
        return fmt::format("{} is brighter by {:.2f}, {:.2f}, {:.2f} levels in the mean of red, green, blue", what,
                           means[0], means[1], means[2]);
    }
    return "";
}

}  // namespace

std::filesystem::path folder(const std::string& kind) {
    return std::filesystem::path(SANDWALL_SOURCE_DIR) / "tests/images" / kind;
}

bool isBlank(const Image& image) {
    std::set<int> colours;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        colours.insert(image.rgb[i] << 16 | image.rgb[i + 1] << 8 | image.rgb[i + 2]);
    }
    return colours.size() < 100;
}

std::string fault(const Image& expected, const Image& got, const Mask& tool) {
    const pictures::Comparison comparison = pictures::compare(expected, got, kLevels);
    const std::string whole = faultWithin("the picture", Mask(expected.pixels(), 1), expected, got, comparison);
    return !whole.empty() || tool.empty() ? whole : faultWithin("the tool's part", tool, expected, got, comparison);
}

void expect(const std::filesystem::path& folder, const std::string& name, const Image& got, const Mask& tool) {
    const std::filesystem::path file = folder / (name + ".png");
    EXPECT_FALSE(isBlank(got)) << name;
    EXPECT_TRUE(tool.empty() || std::count(tool.begin(), tool.end(), 1) > 0) << name << " shows no tool";
    if (writesGoldens()) {
        std::filesystem::create_directories(folder);
        pictures::writePng(file, got);
        // A run that compares no picture must not pass.
        ADD_FAILURE() << "wrote " << file << "; look at it, and run again without SANDWALL_WRITE_GOLDENS";
        return;
    }
    if (!std::filesystem::exists(file)) {
        leave(name, got, nullptr, nullptr);
        ADD_FAILURE() << "no golden picture " << file << "; " << kFailures / (name + ".got.png") << ": " << kHow;
        return;
    }
    const Image expected = pictures::readPng(file);
    EXPECT_FALSE(isBlank(expected)) << file;
    if (expected.width != got.width || expected.height != got.height) {
        leave(name, got, &expected, nullptr);
        ADD_FAILURE() << file << " has another size than the wall; " << kHow;
        return;
    }
    EXPECT_GT(pictures::compare(expected, pictures::shifted(got, 1, 0), kLevels).badShare, kMostBad)
        << name << " shows too little to detect a shift of one pixel";
    if (const std::string why = fault(expected, got, tool); !why.empty()) {
        const Image difference = pictures::differenceImage(expected, pictures::compare(expected, got, kLevels));
        leave(name, got, &expected, &difference);
        ADD_FAILURE() << name << ": " << why << "; " << kFailures << " holds got, want and diff; " << kHow;
    }
}

}  // namespace golden
