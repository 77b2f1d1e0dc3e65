// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/wall_text.hpp"
#include "walls/canvas.hpp"

namespace {

constexpr int kLevels = 8;
constexpr double kMostBad = 0.01;

walls::Wall config(const std::string& name, double factor) {
    return support::reduced(walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/" + name + ".toml"), factor);
}

/// Tiles of real ranks against pictures of single ranks that see the same through one camera. The renderer decides
/// pixels at silhouettes either way; a picture one pixel off, or of the other eye, must not pass the same test.
class Seam : public SessionTest {
protected:
    void show(const std::string& name, const walls::Wall& wall) {
        const Ended ended = runToEnd({"--wall", write(name + ".toml", support::wallText(wall)), "--scene", scene(),
                                      "--device", "script:gis", "--pace", "fast", "--steps", "120", "--track", "none",
                                      "--here", "--gl", "osmesa", "--out", (folder_ / name).string()},
                                     300);
        ASSERT_EQ(ended.status, 0) << ended.output;
    }
    [[nodiscard]] pictures::Image picture(const std::string& session, const std::string& tile,
                                          const std::string& eye) const {
        return pictures::readPng(folder_ / session / fmt::format("tile_{}_{}.png", tile, eye));
    }

    static void expectTheSame(const pictures::Image& expected, const pictures::Image& otherEye,
                              const pictures::Image& got, const std::string& what) {
        SCOPED_TRACE(what);
        const pictures::Comparison same = pictures::compare(expected, got, kLevels);
        EXPECT_LE(same.badShare, kMostBad);
        EXPECT_EQ(pictures::countOutside(same.bad, pictures::silhouettes(expected, kLevels)), 0);
        // What shows background alone is the same wherever it is moved to.
        if (isPlain(expected)) {
            return;
        }
        ++featured_;
        EXPECT_GT(pictures::compare(expected, pictures::shifted(got, 1, 0), kLevels).badShare, kMostBad);
        EXPECT_GT(pictures::compare(expected, pictures::shifted(got, 0, 1), kLevels).badShare, kMostBad);
        EXPECT_GT(pictures::compare(otherEye, got, kLevels).badShare, kMostBad) << "eyes told apart";
    }
    /// Whether hardly a pixel differs from its neighbour: background alone, or nearly.
    static bool isPlain(const pictures::Image& image) {
        return pictures::compare(image, pictures::shifted(image, 1, 1), kLevels).badShare < 0.05;
    }

    /// Every tile of the grid is its part of one rank's picture of the whole grid.
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
    /// Every explicit screen shows what one rank shows that has it alone.
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
    inline static int featured_ = 0;  // pictures that could tell a shift
};

TEST_F(Seam, TilesOfThePapersWallAreOneCameraWithoutTheBezels) {
    const walls::Wall wall = config("tiled_3x4", 0.2);
    show("tiled", wall);
    featured_ = 0;
    expectCropsOfTheGrid("tiled", wall);
    EXPECT_GE(featured_, 12) << "hardly any tile shows sand";
}

TEST_F(Seam, FacesOfTheCaveAreWhatOneCameraSeesThroughEach) {
    const walls::Wall wall = config("flex_cave", 0.2);
    show("cave", wall);
    featured_ = 0;
    expectScreensOfTheirOwn("cave", wall);
    EXPECT_GE(featured_, 4) << "hardly any face shows sand";
}

TEST_F(Seam, AGridAndAScreenBesideItAreOneWall) {
    walls::Wall wall = walls::loadWall(this->wall(2, 2));
    walls::Tile desk = wall.tiles.back();
    desk.rank = 5;
    desk.row = desk.column = 0;
    desk.name = "desk";
    desk.screen = {{-0.5, 0.38, 0.8}, {0.5, 0.38, 0.8}, {-0.5, 0.38, 0.05}};
    desk.outputs = walls::outputsOf(wall.stereo, desk.name);
    wall.tiles.push_back(desk);
    show("mixed", wall);
    featured_ = 0;
    expectCropsOfTheGrid("mixed", wall);
    expectScreensOfTheirOwn("mixed", wall);
    EXPECT_GE(featured_, 8) << "hardly any tile shows sand";
}

}  // namespace
