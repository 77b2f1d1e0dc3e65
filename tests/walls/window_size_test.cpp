// SPDX-License-Identifier: Apache-2.0
#include "walls/window_size.hpp"

#include <gtest/gtest.h>

#include "tests/walls/sample_walls.hpp"
#include "walls/wall_check.hpp"

namespace walls {
namespace {

TEST(WindowSize, FollowsTheOnlyWindowOfAWallFileThatDoesNotPlaceIt) {
    Wall wall = config("desktop.toml");
    EXPECT_TRUE(followsWindow(wall));
    EXPECT_TRUE(followsWindow(shownIn(wall, Stereo::anaglyphColour)));
    EXPECT_FALSE(followsWindow(shownIn(wall, Stereo::passive))) << "two outputs";
    EXPECT_FALSE(followsWindow(config("tiled_3x4.toml")));
    wall.tiles[0].outputs[0].window = glm::ivec2(0, 0);
    EXPECT_FALSE(followsWindow(wall));
    wall.tiles[0].outputs[0].window.reset();
    wall.tiles[0].outputs[0].monitor = "DP-1";
    EXPECT_FALSE(followsWindow(wall));
}

TEST(WindowSize, OfTheWallFileChangesNothing) {
    const Wall wall = config("desktop.toml");
    EXPECT_EQ(shownInWindow(wall, {0, 0}), wall);
    const Wall same = shownInWindow(wall, {1280, 720});
    EXPECT_EQ(same.tiles[0].pixels, wall.tiles[0].pixels);
    EXPECT_NEAR(same.tiles[0].screen.width(), 0.531, 0.001);
}

/// Expects square pixels, and that the screen covers the whole screen of the wall file about the same middle.
void expectCovers(const Wall& wall, const Wall& shown) {
    const Screen &file = wall.tiles[0].screen, &screen = shown.tiles[0].screen;
    const glm::dvec2 before = glm::dvec2(file.width(), file.height()) / glm::dvec2(wall.tiles[0].pixels);
    const glm::dvec2 now = glm::dvec2(screen.width(), screen.height()) / glm::dvec2(shown.tiles[0].pixels);
    EXPECT_NEAR(now.x / now.y, before.x / before.y, 1e-12);
    EXPECT_GE(screen.width(), file.width() - 1e-12);
    EXPECT_GE(screen.height(), file.height() - 1e-12);
    EXPECT_NEAR(std::min(screen.width() / file.width(), screen.height() / file.height()), 1, 1e-12);
    EXPECT_LT(glm::distance(screen.lowerRight + screen.upperLeft, file.lowerRight + file.upperLeft), 1e-9);
    EXPECT_FALSE(viewFault(shown).has_value());
    EXPECT_EQ(Wall::decode(shown.encode()), shown);
}

TEST(WindowSize, AWiderOrHigherWindowShowsMoreBesideTheScreenOfTheWallFile) {
    const Wall wall = config("desktop.toml");
    for (const glm::ivec2 window : {glm::ivec2(1000, 300), glm::ivec2(300, 1000), glm::ivec2(1920, 1200)}) {
        const Wall shown = shownInWindow(wall, window);
        EXPECT_EQ(shown.tiles[0].pixels, window);
        EXPECT_EQ(shown.grid->tilePixels, window);
        EXPECT_EQ(wallCanvas(shown).width, window.x) << "pictures of the wall have the size of the window";
        expectCovers(wall, shown);
    }
}

TEST(WindowSize, OfOnePixelOrOfFarTooManyStillIsAPicture) {
    const Wall wall = config("desktop.toml");
    const auto pixels = [&](int width, int height) { return shownInWindow(wall, {width, height}).tiles[0].pixels; };
    EXPECT_EQ(pixels(1, 1), glm::ivec2(kLeastWindowSide));
    EXPECT_EQ(pixels(1, 800), glm::ivec2(kLeastWindowSide, 800));
    EXPECT_EQ(pixels(60000, 60000), glm::ivec2(kMaxTileSide));
    expectCovers(wall, shownInWindow(wall, {1, 800}));
}

TEST(WindowSize, IsDividedAmongEyesThatShareABuffer) {
    const Wall wall = shownIn(config("desktop.toml"), Stereo::sideBySide);
    const Wall shown = shownInWindow(wall, {801, 600});
    EXPECT_EQ(shown.tiles[0].pixels, glm::ivec2(400, 600));
    expectCovers(wall, shown);
}

}  // namespace
}  // namespace walls
