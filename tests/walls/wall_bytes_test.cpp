// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/seed.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

TEST(WallBytes, GiveBackTheWholeWall) {
    for (const std::string& name : configNames()) {
        const Wall wall = config(name);
        EXPECT_EQ(Wall::decode(wall.encode()), wall) << name;
    }
}

/// Returns a wall in which every field has a different value.
Wall fullWall() {
    Wall wall = config("tiled_3x4.toml");
    wall.refreshHz = 119.88;
    wall.tracking = "dtrack:5000:2";
    wall.onDesk = true;
    wall.tiles[0].place = {"node1", ":0.1", 3};
    wall.tiles[0].outputs[0].monitor = "DP-1";
    wall.tiles[0].outputs[1].monitor = "DP-2";
    wall.tiles[1].outputs[0].window = glm::ivec2(-5, 0);
    wall.tiles[1].outputs[1].window = glm::ivec2(1024, 768);
    Tile floor;
    floor.rank = 13;
    floor.name = "floor";
    floor.screen = {{-2, 0, 2}, {2, 0, 2}, {-2, 0, 0.5}};
    floor.pixels = {800, 300};
    floor.outputs = outputsOf(wall.stereo, "floor");
    wall.tiles.push_back(floor);
    return wall;
}

TEST(WallBytes, CarryPlacesMonitorsWindowsRefreshAndTracking) {
    const Wall wall = fullWall();
    const Wall again = Wall::decode(wall.encode());
    EXPECT_EQ(again, wall);
    EXPECT_EQ(again.refreshHz, 119.88);
    EXPECT_EQ(again.tracking, "dtrack:5000:2");
    EXPECT_EQ(again.tiles[0].place.device, 3);
    EXPECT_EQ(again.tiles[1].outputs[0].window, glm::ivec2(-5, 0));
    EXPECT_EQ(again.tiles[2].outputs[0].window, std::nullopt);
}

TEST(WallBytes, AreRefusedForAWallThatCannotBe) {
    const double nan = std::nan("");
    const std::vector<std::pair<const char*, std::function<void(Wall&)>>> cases{
        {"an eye nowhere", [&](Wall& w) { w.viewer.eye.y = nan; }},
        {"eyes in one place", [](Wall& w) { w.viewer.eyeSeparation = 0; }},
        {"eyes exchanged", [](Wall& w) { w.viewer.eyeSeparation = -0.065; }},
        {"a direction of no length", [](Wall& w) { w.viewer.right = glm::dvec3(0); }},
        {"a direction too long",
         [](Wall& w) {
             w.viewer.right = {2, 0, 0};
         }},
        {"a stereo nobody knows", [](Wall& w) { w.stereo = static_cast<Stereo>(12); }},
        {"no frames", [](Wall& w) { w.refreshHz = 0; }},
        {"endless frames", [&](Wall& w) { w.refreshHz = HUGE_VAL; }},
        {"tracking over two lines", [](Wall& w) { w.tracking = "trace:a\nb"; }},
        {"near behind the eye", [](Wall& w) { w.clip.near = -1; }},
        {"far before near", [](Wall& w) { w.clip.far = w.clip.near; }},
        {"sand without size", [](Wall& w) { w.stage.width = 0; }},
        {"a tilt of any size", [&](Wall& w) { w.stage.tiltDegrees = nan; }},
        {"a grid without rows", [](Wall& w) { w.grid->rows = 0; }},
        {"a grid with more tiles than there are", [](Wall& w) { w.grid->rows = 4; }},
        {"a grid with fewer columns than its tiles", [](Wall& w) { w.grid->columns = 3; }},
        {"bezels wider than tiles", [](Wall& w) { w.grid->bezel.x = 2; }},
        {"tiles that overlap whole", [](Wall& w) { w.grid->bezel.x = -w.grid->tileSize.x; }},
        {"tiles without a grid", [](Wall& w) { w.grid.reset(); }},
        {"no tiles", [](Wall& w) { w.tiles.clear(); }},
        {"a rank twice", [](Wall& w) { w.tiles[3].rank = 3; }},
        {"a tile of another row", [](Wall& w) { w.tiles[3].row = 2; }},
        {"a tile of the grid with a name of its own", [](Wall& w) { w.tiles[3].name = "tv"; }},
        {"a name twice", [](Wall& w) { w.tiles[12].name = "r1c1"; }},
        {"a name that is a path", [](Wall& w) { w.tiles[12].name = "../floor"; }},
        {"a tile without pixels", [](Wall& w) { w.tiles[12].pixels.x = 0; }},
        {"a tile of too many pixels", [](Wall& w) { w.tiles[12].pixels.y = kMaxTileSide + 1; }},
        {"a tile without size", [](Wall& w) { w.tiles[12].screen.lowerRight = w.tiles[12].screen.lowerLeft; }},
        {"a tile askew", [](Wall& w) { w.tiles[12].screen.upperLeft.x += 0.1; }},
        {"a device before the first", [](Wall& w) { w.tiles[0].place.device = -2; }},
        {"a tile without outputs", [](Wall& w) { w.tiles[5].outputs.clear(); }},
        {"an output too few", [](Wall& w) { w.tiles[5].outputs.pop_back(); }},
        {"an output without eyes", [](Wall& w) { w.tiles[5].outputs[1].eyes.clear(); }},
        {"eyes of another stereo", [](Wall& w) { w.tiles[5].outputs[0].eyes = {Eye::middle}; }},
        {"outputs of another stereo", [](Wall& w) { w.stereo = Stereo::active; }},
        {"eyes exchanged between outputs",
         [](Wall& w) { std::swap(w.tiles[5].outputs[0].eyes, w.tiles[5].outputs[1].eyes); }},
        {"an eye that does not exist", [](Wall& w) { w.tiles[5].outputs[0].eyes = {static_cast<Eye>(3)}; }},
        {"monitor and window at once", [](Wall& w) { w.tiles[0].outputs[0].window = glm::ivec2(0); }},
    };
    for (const auto& [what, spoil] : cases) {
        Wall wall = fullWall();
        spoil(wall);
        EXPECT_THROW((void)Wall::decode(wall.encode()), base::FormatError) << what;
    }
}

TEST(WallBytes, OfTheLargestGridAreTaken) {
    Wall wall = config("desktop.toml");
    wall.grid->rows = wall.grid->columns = 32;
    wall.tiles = tilesOf(*wall.grid, wall.stereo);
    ASSERT_EQ(wall.ranks(), kMaxTiles);
    EXPECT_EQ(Wall::decode(wall.encode()), wall);
}

TEST(WallBytes, AreRefusedWhenCutShortAnywhereOrTooLong) {
    base::Bytes bytes = config("desktop.toml").encode();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_THROW((void)Wall::decode(std::span(bytes).first(size)), base::FormatError) << size;
    }
    bytes.push_back(0);
    EXPECT_THROW((void)Wall::decode(bytes), base::FormatError);
}

TEST(WallBytes, DamagedGiveAWallThatCanBeLaidOutOrAreRefused) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const base::Bytes whole = config("tiled_3x4.toml").encode();
    int refused = 0;
    for (int round = 0; round < 3000; ++round) {
        base::Bytes bytes = whole;
        bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1 << random() % 8);
        try {
            EXPECT_EQ(wallCanvas(Wall::decode(bytes)).tiles.size(), 12U);
        } catch (const base::FormatError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace walls
