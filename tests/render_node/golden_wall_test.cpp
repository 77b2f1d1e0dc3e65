// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <set>

#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"
#include "render_node/gl/gl_context.hpp"
#include "wall_painter.hpp"

namespace {

using pictures::Image;

constexpr int kLevels = 8;
// The same renderer gives the same pixels; another version of it, or another processor, may decide a silhouette or
// round a grain the other way.
constexpr double kMostBad = 0.005;
constexpr int kMostPixels = 45000;  // of a golden picture, for the sake of the repository

const std::filesystem::path kGoldens = std::filesystem::path(SANDWALL_SOURCE_DIR) / "tests/images/golden";
const std::filesystem::path kFailures = std::filesystem::path(SANDWALL_BIN_DIR).parent_path() / "golden_failures";
constexpr const char* kHow =
    "look at the picture; if it is right: SANDWALL_WRITE_GOLDENS=1 bin/render_node_tests "
    "--gtest_filter='GoldenWalls.*'";

bool writesGoldens() {
    const char* wish = std::getenv("SANDWALL_WRITE_GOLDENS");
    return wish != nullptr && std::string(wish) == "1";
}

/// Whether there is something to see: a blank picture has a colour, a broken one a few.
bool isBlank(const Image& image) {
    std::set<int> colours;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        colours.insert(image.rgb[i] << 16 | image.rgb[i + 1] << 8 | image.rgb[i + 2]);
    }
    return colours.size() < 100;
}

class GoldenWalls : public testing::Test {
protected:
    /// The wall from end to end, small.
    Image pictureOfWall(const walls::Wall& full) const {
        const walls::Canvas canvas = walls::wallCanvas(full);
        const auto divides = [&](int by) {
            return std::all_of(full.tiles.begin(), full.tiles.end(),
                               [by](const walls::Tile& t) { return t.pixels.x % by == 0 && t.pixels.y % by == 0; });
        };
        int by = 1;
        while (canvas.width / by * (canvas.height / by) > kMostPixels || !divides(by)) {
            ++by;
        }
        const walls::Wall wall = sample::reduced(full, by);
        render_node::SandView view = sample::makeView(dug_, wall);
        std::vector<std::vector<Image>> outputs;
        for (const walls::Tile& tile : wall.tiles) {
            outputs.push_back(sample::outputsOf(view, wall, tile));
        }
        return sample::wallOfOutputs(wall, outputs);
    }

    /// Leaves got, and want and what differs where there is a golden.
    static void leave(const std::string& name, const Image& got, const Image* want, const Image* difference) {
        std::filesystem::create_directories(kFailures);
        pictures::writePng(kFailures / (name + ".got.png"), got);
        if (want != nullptr) {
            pictures::writePng(kFailures / (name + ".want.png"), *want);
        }
        if (difference != nullptr) {
            pictures::writePng(kFailures / (name + ".diff.png"), *difference);
        }
    }

    static void check(const std::string& name, const Image& got) {
        const std::filesystem::path file = kGoldens / (name + ".png");
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

    std::unique_ptr<render_node::GlContext> context_ = render_node::makeOffscreenContext(render_node::Backend::osmesa);
    sample::DugScene dug_;
};

TEST_F(GoldenWalls, LookAsTheyDid) {
    ASSERT_FALSE(sample::wallNames().empty());
    for (const std::string& name : sample::wallNames()) {
        SCOPED_TRACE(name);
        const Image got = pictureOfWall(walls::loadWall(sample::wallFolder() / (name + ".toml")));
        EXPECT_FALSE(isBlank(got)) << name;
        if (writesGoldens()) {
            std::filesystem::create_directories(kGoldens);
            pictures::writePng(kGoldens / (name + ".png"), got);
        } else {
            check(name, got);
        }
    }
}

TEST_F(GoldenWalls, AreThoseOfTheWallFiles) {
    std::set<std::string> goldens;
    for (const auto& entry : std::filesystem::directory_iterator(kGoldens)) {
        goldens.insert(entry.path().stem().string());
    }
    const auto names = sample::wallNames();
    EXPECT_EQ(goldens, std::set<std::string>(names.begin(), names.end()));
}

}  // namespace
