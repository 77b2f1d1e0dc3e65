// SPDX-License-Identifier: Apache-2.0
#include "walls/desk_windows.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/seed.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

Wall on(const std::string& name, const DeskArea& area) { return placedOnDesk(config(name), area, name); }

PixelRect windowOf(const Tile& tile) {
    const glm::ivec2 corner = tile.outputs.front().window.value();
    return {corner.x, corner.y, tile.pixels.x, tile.pixels.y};
}

bool overlap(const PixelRect& a, const PixelRect& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// Expects one window of one eye per tile, all of them within the area, beside each other, and scaled alike.
void expectPlaced(const Wall& wall, const Wall& desk, const DeskArea& area) {
    EXPECT_EQ(Wall::decode(desk.encode()), desk);
    EXPECT_TRUE(desk.onDesk);
    EXPECT_EQ(desk.stereo, Stereo::mono);
    EXPECT_EQ(desk.tracking, "");
    ASSERT_EQ(desk.tiles.size(), wall.tiles.size());
    const Wall mono = shownIn(wall, Stereo::mono);
    for (std::size_t i = 0; i < desk.tiles.size(); ++i) {
        const Tile& tile = desk.tiles[i];
        ASSERT_EQ(tile.outputs.size(), 1U);
        EXPECT_EQ(tile.screen, wall.tiles[i].screen);
        EXPECT_EQ(tile.place, Place{});
        EXPECT_EQ(tile.outputs[0].monitor, "");
        const PixelRect window = windowOf(tile);
        EXPECT_GE(window.x, area.corner.x);
        EXPECT_GE(window.y, area.corner.y);
        EXPECT_LE(window.x + window.width, area.corner.x + area.size.x);
        EXPECT_LE(window.y + window.height, area.corner.y + area.size.y);
        for (std::size_t other = 0; other < i; ++other) {
            EXPECT_FALSE(overlap(window, windowOf(desk.tiles[other]))) << tile.name << ", " << desk.tiles[other].name;
            // Rounding to whole pixels moves each side by less than one.
            const double mine = double(tile.pixels.x) / mono.tiles[i].pixels.x;
            const double others = double(desk.tiles[other].pixels.x) / mono.tiles[other].pixels.x;
            EXPECT_NEAR(mine, others, 1.0 / std::min(mono.tiles[i].pixels.x, mono.tiles[other].pixels.x));
        }
    }
}

// 4 · 1024 + 3 · 10 = 4126 and 3 · 768 + 2 · 10 = 2324 pixels. 1600 / 4126 = 0.38778 is less than 1000 / 2324. So tiles
// have 397 x 297 pixels, and gaps 3. The whole has 4 · 397 + 9 = 1597 and 3 · 297 + 6 = 897 pixels.
TEST(DeskWindows, OfAGridHaveItsRowsColumnsAndBezels) {
    const DeskArea area{{1600, 1000}, {10, 20}};
    const Wall desk = on("tiled_3x4.toml", area);
    expectPlaced(config("tiled_3x4.toml"), desk, area);
    for (const Tile& tile : desk.tiles) {
        EXPECT_EQ(tile.pixels, glm::ivec2(397, 297));
        EXPECT_EQ(tile.outputs[0].window, glm::ivec2(10 + 1 + 400 * (tile.column - 1), 20 + 51 + 300 * (tile.row - 1)));
    }
    EXPECT_EQ(desk.grid->tilePixels, glm::ivec2(397, 297));
    EXPECT_EQ(desk.refreshHz, 60);
}

// The map has left, front and right in one row, and the floor below the front: 768 + 1024 + 768 = 2560 pixels across
// and 768 + 768 = 1536 down. 1920 / 2560 = 0.75 is more than 1080 / 1536 = 0.703125. So the whole is 540 + 720 + 540 =
// 1800 wide.
TEST(DeskWindows, OfScreensAreBesideEachOtherAsInTheMap) {
    const DeskArea area{{1920, 1080}, {0, 0}};
    const Wall desk = on("flex_cave.toml", area);
    expectPlaced(config("flex_cave.toml"), desk, area);
    const auto window = [&](std::size_t i) { return desk.tiles[i].outputs[0].window.value(); };
    EXPECT_EQ(desk.tiles[0].pixels, glm::ivec2(540));
    EXPECT_EQ(desk.tiles[3].pixels, glm::ivec2(720, 540));
    EXPECT_EQ(window(0), glm::ivec2(60, 0)) << "left";
    EXPECT_EQ(window(1), glm::ivec2(600, 0)) << "front";
    EXPECT_EQ(window(2), glm::ivec2(1320, 0)) << "right";
    EXPECT_EQ(window(3), glm::ivec2(600, 540)) << "floor";
    EXPECT_EQ(desk.refreshHz, 60) << "120 frames a second showed each eye in every second one";
}

TEST(DeskWindows, AreNoLargerThanTheTiles) {
    const DeskArea area{{9000, 5000}, {0, 0}};
    const Wall desk = on("tiled_3x4.toml", area);
    EXPECT_EQ(desk.tiles[0].pixels, glm::ivec2(1024, 768));
    EXPECT_EQ(desk.tiles[0].outputs[0].window, glm::ivec2((9000 - 4126) / 2, (5000 - 2324) / 2));
}

TEST(DeskWindows, OfProjectorsThatOverlapTouch) {
    Wall wall = config("tiled_3x4.toml");
    wall.grid->bezel = {-0.1, -0.1};
    wall.tiles = tilesOf(*wall.grid, wall.stereo);
    const DeskArea area{{2048, 2000}, {0, 0}};
    const Wall desk = placedOnDesk(wall, area, "overlap");
    expectPlaced(wall, desk, area);
    EXPECT_EQ(desk.tiles[0].pixels, glm::ivec2(512, 384));
    EXPECT_EQ(desk.tiles[1].outputs[0].window->x, 512);
}

TEST(DeskWindows, OfEverySampleFitOnAnyDesktop) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    for (const std::string& name : configNames()) {
        for (int i = 0; i < 20; ++i) {
            const DeskArea area{{100 + static_cast<int>(random() % 3000), 100 + static_cast<int>(random() % 2000)},
                                {static_cast<int>(random() % 50), static_cast<int>(random() % 50)}};
            SCOPED_TRACE(name + " on " + std::to_string(area.size.x) + " x " + std::to_string(area.size.y));
            expectPlaced(config(name), on(name, area), area);
        }
    }
}

std::string refusal(const std::string& name, const DeskArea& area) {
    try {
        (void)on(name, area);
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "placed";
}

TEST(DeskWindows, AreRefusedIfAPixelPerTileIsTooMuch) {
    EXPECT_EQ(refusal("tiled_3x4.toml", {{4, 3}, {0, 0}}), "placed");
    EXPECT_EQ(refusal("tiled_3x4.toml", {{3, 300}, {0, 0}}),
              "tiled_3x4.toml: its 12 tiles do not fit on a desktop of 3x300 pixels, even at one pixel each; choose "
              "another wall");
    EXPECT_NE(refusal("flex_cave.toml", {{300, 1}, {0, 0}}), "placed");
}

TEST(DeskWindows, AnAreaIsReadAsAnXGeometry) {
    EXPECT_EQ(DeskArea::parse("1600x900+0+27", "--desk"), (DeskArea{{1600, 900}, {0, 27}}));
    for (const char* text :
         {"", "1600x900", "1600x900+0", "1600x900+0+27+", "1600x900+0+27 ", "0x900+0+0", "1600x-9+0+0", "1600x900+-1+0",
          "x900+0+0", "1600x900+0+99999999999", "9999999x900+0+0", "1600X900+0+0"}) {
        EXPECT_THROW((void)DeskArea::parse(text, "--desk"), base::InputError) << text;
    }
}

}  // namespace
}  // namespace walls
