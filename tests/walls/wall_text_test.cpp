// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/wall_text.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

TEST(WallText, GivesTheWallBack) {
    for (const std::string& name : configNames()) {
        Wall wall = config(name);
        wall.tiles[0].place = {"node1", ":0", 2};
        EXPECT_EQ(parseWall(support::wallText(wall), "again.toml"), wall) << name;
    }
}

TEST(WallText, OfAReducedWallHasFewerPixelsAndAsManyMetres) {
    const Wall wall = parseWall(support::reducedWall(configFolder() / "tiled_3x4.toml", 1.0 / 8), "small.toml");
    const Wall was = config("tiled_3x4.toml");
    EXPECT_EQ(wall.tiles[5].pixels, glm::ivec2(128, 96));
    EXPECT_EQ(wall.tiles[5].screen.width(), was.tiles[5].screen.width());
    EXPECT_NEAR(wall.grid->bezel.x, 0.008, 1e-15) << "one whole pixel, where 10 mm would be 1.25";
    const Wall beside = parseWall(support::reducedWall(configFolder() / "projection_screen.toml", 0.25), "small.toml");
    EXPECT_EQ(beside.tiles[0].outputs[1].window, glm::ivec2(256, 0));
}

TEST(WallText, ReducesEverySampleToAWall) {
    for (const std::string& name : configNames()) {
        const Wall wall = parseWall(support::reducedWall(configFolder() / name, 0.1), name);
        EXPECT_EQ(wall.ranks(), config(name).ranks()) << name;
        EXPECT_LE(wall.tiles[0].pixels.x, 256) << name;
    }
}

TEST(WallText, PutsOneCameraBeforeAGridAndOneBeforeAScreen) {
    const std::string mixed =
        support::wallText(support::reduced(config("tiled_3x4.toml"), 0.25)) +
        "[[screen]]\nname = \"floor\"\nlower_left = [-2, 0, 2]\nlower_right = [2, 0, 2]\nupper_left = [-2, 0, 0.5]\n"
        "pixels = [400, 150]\n";
    const Wall wall = parseWall(mixed, "mixed.toml");
    ASSERT_EQ(wall.ranks(), 13);
    const Wall whole = parseWall(support::wallText(support::wholeWallOf(wall)), "whole.toml");
    ASSERT_EQ(whole.ranks(), 1);
    EXPECT_EQ(whole.tiles[0].pixels, glm::ivec2(4 * 256 + 3 * 3, 3 * 192 + 2 * 3));
    const Canvas canvas = wallCanvas(wall);
    EXPECT_EQ(canvas.tiles[11].x + canvas.tiles[11].width, whole.tiles[0].pixels.x);
    const Wall floor = parseWall(support::wallText(support::wholeWallOf(wall, "floor")), "floor.toml");
    ASSERT_EQ(floor.ranks(), 1);
    EXPECT_EQ(floor.tiles[0].screen, wall.tiles[12].screen);
    EXPECT_EQ(floor.tiles[0].pixels, glm::ivec2(400, 150));
    const Wall one =
        parseWall(support::wallText(support::wholeWallOf(config("flex_cave.toml"), "right")), "right.toml");
    EXPECT_EQ(one.tiles[0].screen, config("flex_cave.toml").tiles[2].screen);
}

}  // namespace
}  // namespace walls
