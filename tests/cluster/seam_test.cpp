// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/files/wall_text.hpp"
#include "walls/canvas.hpp"

namespace {

/// Compares tiles of real ranks with pictures of single ranks that see the same through one camera. The renderer may
/// decide pixels at silhouettes either way. A picture that is shifted by one pixel, or of the other eye, must not pass
/// the same comparison. One wall has both kinds of tiles. tests/render_node/wall_seam_test.cpp does the same for every
/// sample wall in one process.
class Seam : public SessionTest {
protected:
    void show(const std::string& name, const walls::Wall& wall) {
        const Ended ended = runToEnd({"--wall", write(name + ".toml", support::wallText(wall)), "--scene", scene(),
                                      "--device", "script:gis", "--pace", "fast", "--steps", "60", "--track", "none",
                                      "--here", "--gl", "osmesa", "--out", (folder_ / name).string()});
        ASSERT_EQ(ended.status, 0) << ended.output;
    }
    [[nodiscard]] pictures::Image picture(const std::string& session, const std::string& tile,
                                          const std::string& eye) const {
        return pictures::readPng(folder_ / session / fmt::format("tile_{}_{}.png", tile, eye));
    }

    void expectTheSame(const pictures::Image& expected, const pictures::Image& otherEye, const pictures::Image& got,
                       const std::string& what) {
        SCOPED_TRACE(what);
        const pictures::Comparison same = pictures::compare(expected, got, kLevels);
        EXPECT_LE(same.badShare, kMostBad);
        EXPECT_EQ(pictures::countOutside(same.bad, pictures::silhouettes(expected, kLevels)), 0);
        const auto differs = [&](const pictures::Image& other) {
            return pictures::compare(other, got, kLevels).badShare > kMostBad ? 1 : 0;
        };
        shiftsSeen_ += differs(pictures::shifted(expected, 1, 0)) * differs(pictures::shifted(expected, 0, 1));
        eyesSeen_ += differs(otherEye);
        ++compared_;
    }
    /// Every tile of the grid must equal its part of one rank's picture of the whole grid.
    void expectCropsOfTheGrid(const std::string& session, const walls::Wall& wall) {
        const walls::Wall whole = support::wholeWallOf(wall);
        show("whole", whole);
        walls::Wall grid = wall;
        std::erase_if(grid.tiles, [](const walls::Tile& tile) { return tile.row == 0; });
        const walls::Canvas canvas = walls::wallCanvas(grid);
        for (const std::string eye : {"left", "right"}) {
            const pictures::Image expected = picture("whole", whole.tiles[0].name, eye);
            const pictures::Image other = picture("whole", whole.tiles[0].name, eye == "left" ? "right" : "left");
            for (std::size_t i = 0; i < grid.tiles.size(); ++i) {
                const walls::PixelRect& part = canvas.tiles[i];
                const auto crop = [&](const pictures::Image& image) {
                    return pictures::crop(image, part.x, part.y, part.width, part.height);
                };
                expectTheSame(crop(expected), crop(other), picture(session, grid.tiles[i].name, eye),
                              grid.tiles[i].name + " " + eye);
            }
        }
    }
    /// Every explicit screen must show the same picture as a rank that draws this screen alone.
    void expectScreensOfTheirOwn(const std::string& session, const walls::Wall& wall) {
        for (const walls::Tile& tile : wall.tiles) {
            if (tile.row != 0) {
                continue;
            }
            show("alone_" + tile.name, support::wholeWallOf(wall, tile.name));
            for (const std::string eye : {"left", "right"}) {
                expectTheSame(picture("alone_" + tile.name, tile.name, eye),
                              picture("alone_" + tile.name, tile.name, eye == "left" ? "right" : "left"),
                              picture(session, tile.name, eye), tile.name + " " + eye);
            }
        }
    }
    int compared_ = 0, shiftsSeen_ = 0, eyesSeen_ = 0;  // pictures
};

// The wall has sand on every tile, near and far, and a desk in front of it. Every picture must reveal both faults.
TEST_F(Seam, EveryTileIsTheCropOfTheWholeWallAndAScreenBesideItIsAsIfAlone) {
    walls::Wall wall = walls::loadWall(this->wall(2, 2));
    wall.viewer.eye = {0.1, 1.5, 2.5};
    wall.stage = {{0, 1.1, 0}, 1.9, 40, 0};
    walls::Grid& grid = *wall.grid;
    grid.tilePixels = {320, 240};
    grid.tileSize = {1, 0.75};
    grid.bezel = {4.0 / 320, 4.0 / 320};
    grid.lowerLeft = {-1, 0.4, 0};
    wall.tiles = walls::tilesOf(grid, wall.stereo);
    walls::Tile desk = wall.tiles.back();
    desk.rank = 5;
    desk.row = desk.column = 0;
    desk.name = "desk";
    desk.screen = {{-0.5, 0.38, 0.8}, {0.5, 0.38, 0.8}, {-0.5, 0.38, 0.05}};
    desk.outputs = walls::outputsOf(wall.stereo, desk.name);
    wall.tiles.push_back(desk);
    show("mixed", wall);
    expectCropsOfTheGrid("mixed", wall);
    expectScreensOfTheirOwn("mixed", wall);
    EXPECT_EQ(compared_, 10);
    EXPECT_EQ(shiftsSeen_, compared_);
    EXPECT_EQ(eyesSeen_, compared_);
}

}  // namespace
