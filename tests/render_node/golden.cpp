// SPDX-License-Identifier: Apache-2.0
#include "tests/render_node/golden.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"

namespace golden {
namespace {

using pictures::Image;

constexpr int kLevels = 8;
// The same renderer gives the same pixels; another version of it, or another processor, may decide a silhouette or
// round a grain the other way.
constexpr double kMostBad = 0.005;

const std::filesystem::path kFailures = std::filesystem::path(SANDWALL_BIN_DIR).parent_path() / "golden_failures";
constexpr const char* kHow =
    "look at the picture; if it is right: SANDWALL_WRITE_GOLDENS=1 bin/render_node_tests --gtest_filter='Golden*'";

bool writesGoldens() {
    const char* wish = std::getenv("SANDWALL_WRITE_GOLDENS");
    return wish != nullptr && std::string(wish) == "1";
}

/// Leaves got, and want and what differs where there is a golden.
void leave(const std::string& name, const Image& got, const Image* want, const Image* difference) {
    std::filesystem::create_directories(kFailures);
    pictures::writePng(kFailures / (name + ".got.png"), got);
    if (want != nullptr) {
        pictures::writePng(kFailures / (name + ".want.png"), *want);
    }
    if (difference != nullptr) {
        pictures::writePng(kFailures / (name + ".diff.png"), *difference);
    }
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

void expect(const std::string& kind, const std::string& name, const Image& got) {
    const std::filesystem::path file = folder(kind) / (name + ".png");
    EXPECT_FALSE(isBlank(got)) << name;
    if (writesGoldens()) {
        std::filesystem::create_directories(folder(kind));
        pictures::writePng(file, got);
        return;
    }
    if (!std::filesystem::exists(file)) {
        leave(name, got, nullptr, nullptr);
        ADD_FAILURE() << "no golden picture " << file << "; " << kFailures / (name + ".got.png") << ": " << kHow;
        return;
    }
    const Image want = pictures::readPng(file);
    EXPECT_FALSE(isBlank(want)) << file;
    if (want.width != got.width || want.height != got.height) {
        leave(name, got, &want, nullptr);
        ADD_FAILURE() << file << " has another size than the wall; " << kHow;
        return;
    }
    EXPECT_GT(pictures::compare(want, pictures::shifted(got, 1, 0), kLevels).badShare, kMostBad)
        << name << " shows too little to tell a pixel's shift";
    const pictures::Comparison comparison = pictures::compare(want, got, kLevels);
    if (comparison.badShare > kMostBad) {
        const Image difference = pictures::differenceImage(want, comparison);
        leave(name, got, &want, &difference);
        ADD_FAILURE() << fmt::format(
            "{}: largest channel difference {}, share of pixels that differ by more than {}: {:.6f}; {} holds "
            "got, want and diff; {}",
            name, comparison.largestDifference, kLevels, comparison.badShare, kFailures.string(), kHow);
    }
}

}  // namespace golden
