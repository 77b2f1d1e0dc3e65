// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"

namespace {

constexpr int kWidth = 320, kHeight = 240, kBezel = 4;  // [pixel]
constexpr int kLevels = 8;
constexpr double kMostBad = 0.01;

/// A grid that covers the same 2 x 2 tiles of a metre's width, in one piece or in four.
std::string gridFile(int tiles) {
    const double pixel = 1.0 / kWidth;
    const int gaps = (2 / tiles - 1);
    const int width = 2 / tiles * kWidth + gaps * kBezel;
    const int height = 2 / tiles * kHeight + gaps * kBezel;
    return fmt::format(
        "name = \"seam\"\n[viewer]\neye = [0.1, 1.5, 2.5]\n[stereo]\nmode = \"passive\"\n[grid]\nrows = {0}\n"
        "columns = {0}\ntile_size = [{1:.17g}, {2:.17g}]\nbezel = [{3:.17g}, {3:.17g}]\ntile_pixels = [{4}, {5}]\n"
        "lower_left = [-1.0, 0.4, 0.0]\n[clip]\nnear = 0.1\nfar = 20.0\n[stage]\ncentre = [0.0, 1.1, 0.0]\n"
        "width = 1.9\ntilt_deg = 40.0\n",
        tiles, width * pixel, height * pixel, kBezel * pixel, width, height);
}

class Seam : public SessionTest {
protected:
    void show(const std::string& name, int tiles) {
        const Ended ended =
            runToEnd({"--wall", write(name + ".toml", gridFile(tiles)), "--scene", scene(), "--device", "script:gis",
                      "--pace", "fast", "--steps", "200", "--out", (folder_ / name).string()});
        ASSERT_EQ(ended.status, 0) << ended.output;
    }
    [[nodiscard]] pictures::Image picture(const std::string& name) const { return pictures::readPng(folder_ / name); }
};

// Tiles of real ranks against the crop of one rank's picture of the whole wall; NUMERICS' renderer decides pixels at
// silhouettes either way. A picture one pixel off, or of the other eye, must not pass the same test.
TEST_F(Seam, EveryTileIsTheCropOfTheWholeWall) {
    show("tiled", 2);
    show("whole", 1);
    for (const std::string eye : {"left", "right"}) {
        const pictures::Image whole = picture("whole/wall_" + eye + ".png");
        for (int tile = 0; tile < 4; ++tile) {
            const int column = tile % 2;
            const int row = tile / 2;
            const auto cropOf = [&](const pictures::Image& image) {
                return pictures::crop(image, column * (kWidth + kBezel), row * (kHeight + kBezel), kWidth, kHeight);
            };
            const pictures::Image expected = cropOf(whole);
            const pictures::Image got = picture(fmt::format("tiled/tile_r{}c{}_{}.png", row + 1, column + 1, eye));
            const pictures::Comparison same = pictures::compare(expected, got, kLevels);
            EXPECT_LE(same.badShare, kMostBad) << eye << " tile " << tile;
            EXPECT_EQ(pictures::countOutside(same.bad, pictures::silhouettes(expected, kLevels)), 0)
                << eye << " tile " << tile;
            EXPECT_GT(pictures::compare(expected, pictures::shifted(got, 1, 0), kLevels).badShare, kMostBad);
            EXPECT_GT(pictures::compare(expected, pictures::shifted(got, 0, 1), kLevels).badShare, kMostBad);
            const pictures::Image other =
                cropOf(picture("whole/wall_" + std::string(eye == "left" ? "right" : "left") + ".png"));
            EXPECT_GT(pictures::compare(other, got, kLevels).badShare, kMostBad) << "eyes told apart";
        }
    }
}

}  // namespace
