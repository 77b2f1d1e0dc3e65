// SPDX-License-Identifier: Apache-2.0
#include "walls/canvas.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <string>

#include "tests/support/seed.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

TEST(Canvas, LaysTheGridOutWithItsBezels) {
    const Canvas canvas = wallCanvas(config("tiled_3x4.toml"));
    EXPECT_EQ(canvas.width, 4 * 1024 + 3 * 10);
    EXPECT_EQ(canvas.height, 3 * 768 + 2 * 10);
    ASSERT_EQ(canvas.tiles.size(), 12U);
    EXPECT_EQ(canvas.tiles[0], (PixelRect{0, 0, 1024, 768}));
    EXPECT_EQ(canvas.tiles[3], (PixelRect{3 * 1034, 0, 1024, 768}));
    EXPECT_EQ(canvas.tiles[8], (PixelRect{0, 2 * 778, 1024, 768}));
}

TEST(Canvas, PutsATileAtTheNearestPixelOfItsPlace) {
    Wall wall = config("tiled_3x4.toml");
    wall.grid->bezel = {0.0104, 0.0026};  // 10.4 and 2.6 pixels
    const Canvas canvas = wallCanvas(wall);
    EXPECT_EQ(canvas.tiles[1].x, 1034);  // 1034.4
    EXPECT_EQ(canvas.tiles[2].x, 2069);  // 2068.8: rounding each gap would lose a pixel here
    EXPECT_EQ(canvas.tiles[3].x, 3103);  // 3103.2
    EXPECT_EQ(canvas.tiles[4].y, 771);   // 770.6
    EXPECT_EQ(canvas.tiles[8].y, 1541);  // 1541.2
}

TEST(Canvas, LaysExplicitScreensSideBySide) {
    const Canvas canvas = wallCanvas(config("flex_cave.toml"));
    EXPECT_EQ(canvas.tiles[0], (PixelRect{0, 0, 768, 768}));
    EXPECT_EQ(canvas.tiles[1], (PixelRect{768 + kScreenGap, 0, 1024, 768}));
    EXPECT_EQ(canvas.width, 2 * 768 + 2 * 1024 + 3 * kScreenGap);
    EXPECT_EQ(canvas.height, 768);
}

TEST(WholeWall, IsOneTileOverTheWholeExtent) {
    const Wall wall = config("tiled_3x4.toml");
    const Wall whole = wholeWall(wall);
    ASSERT_EQ(whole.ranks(), 1);
    EXPECT_EQ(whole.tiles[0].pixels, glm::ivec2(4126, 2324));
    EXPECT_LT(glm::distance(whole.tiles[0].screen.lowerLeft, wall.tiles[8].screen.lowerLeft), 1e-12);
    EXPECT_LT(glm::distance(whole.tiles[0].screen.upperRight(), wall.tiles[3].screen.upperRight()), 1e-12);
    EXPECT_EQ(whole.tiles[0].outputs.size(), 2U);
}

TEST(WholeWall, RefusesWhatHasNoSingleExtent) {
    EXPECT_THROW((void)wholeWall(config("flex_cave.toml")), std::invalid_argument);
    Wall wall = config("tiled_3x4.toml");
    wall.grid->bezel.y = 0.0104;
    EXPECT_THROW((void)wholeWall(wall), std::invalid_argument);
}

TEST(WholeWall, ShowsEveryPointWhereEachOfItsTilesWould) {
    // Every tile's frustum is a part of the wall's one frustum. So a point is at the same pixel of the canvas whichever
    // tile computes it. The point may be in the middle of a tile, on a bezel or two tiles away. A straight line then
    // crosses a bezel straight.
    const Wall wall = config("tiled_3x4.toml");
    const Wall whole = wholeWall(wall);
    const Canvas canvas = wallCanvas(wall);
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> across(-3, 3), up(0, 4), deep(-5, 2);
    for (int round = 0; round < 100; ++round) {
        const glm::dvec3 point(across(random), up(random), deep(random));
        for (const Eye eye : eyesOf(wall.stereo)) {
            const glm::dvec2 expected =
                pixelAt({0, 0, canvas.width, canvas.height}, viewOf(whole, whole.tiles[0], eye), point);
            for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
                const glm::dvec2 got = pixelAt(canvas.tiles[i], viewOf(wall, wall.tiles[i], eye), point);
                EXPECT_LT(glm::distance(got, expected), 1e-6) << wall.tiles[i].name << ", " << eyeName(eye);
            }
        }
    }
}

TEST(WholeWall, PartsTheEyesByTheirParallaxInPixels) {
    // The eyes are 0.065 m apart and 3 m from the wall. The point is 1 m in front of the wall. A pixel is 1 mm.
    const Wall whole = wholeWall(config("tiled_3x4.toml"));
    const PixelRect all{0, 0, 4126, 2324};
    const glm::dvec3 point(0.2, 1.2, 1.0);
    const double left = pixelAt(all, viewOf(whole, whole.tiles[0], Eye::left), point).x;
    const double right = pixelAt(all, viewOf(whole, whole.tiles[0], Eye::right), point).x;
    EXPECT_NEAR(right - left, 65.0 * -1 / (3 - 1), 1e-9);
}

}  // namespace
}  // namespace walls
