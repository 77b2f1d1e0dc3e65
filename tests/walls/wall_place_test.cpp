// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "base/input_error.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

/// Returns a wall with two rows of two tiles, and a floor.
std::string wallWith(const std::string& mode, const std::string& more, const std::string& gap = "") {
    return "refresh = 120\n[viewer]\neye = [0.0, 1.6, 3.0]\n[stereo]\nmode = \"" + mode +
           "\"\n[grid]\nrows = 2\ncolumns = 2\ntile_size = [1.0, 0.75]\n" + gap +
           "\ntile_pixels = [1024, 768]\nlower_left = [-1.0, 0.3, 0.0]\n[[screen]]\nname = \"floor\"\n"
           "lower_left = [-1.0, 0.0, 2.0]\nlower_right = [1.0, 0.0, 2.0]\nupper_left = [-1.0, 0.0, 0.5]\n"
           "pixels = [1024, 768]\n[stage]\ncentre = [0.0, 1.0, -1.0]\nwidth = 2.0\n" +
           more;
}

TEST(WallPlace, GivesEachTileItsMachineAndEachOutputItsMonitor) {
    const Wall wall = parseWall(wallWith("passive", R"(
[[place]]
tiles = ["r1c2", "floor"]
host = "node-2.lab"
display = ":0.1"
device = 1
[[place]]
tiles = ["r1c1"]
host = "10.0.0.7"
monitors = ["DP-1", "DP-2"]
)"),
                                "lab.toml");
    EXPECT_EQ(wall.tiles[0].place, (Place{"10.0.0.7", "", -1}));
    EXPECT_EQ(wall.tiles[0].outputs[0].monitor, "DP-1");
    EXPECT_EQ(wall.tiles[0].outputs[1].monitor, "DP-2");
    EXPECT_EQ(wall.tiles[1].place, (Place{"node-2.lab", ":0.1", 1}));
    EXPECT_EQ(wall.tiles[4].place, (Place{"node-2.lab", ":0.1", 1}));
    EXPECT_EQ(wall.tiles[2].place, Place{}) << "no place is given, so any machine may draw it";
    EXPECT_EQ(wall.tiles[1].outputs[0].monitor, "");
    EXPECT_EQ(wall.tiles[1].outputs[0].window, std::nullopt);
}

TEST(WallPlace, PutsWindowsAtPixels) {
    const Wall wall =
        parseWall(wallWith("passive", "[[place]]\ntiles = [\"r2c1\"]\nwindows = [[0, 0], [1024, -8]]\n"), "lab.toml");
    EXPECT_EQ(wall.tiles[2].outputs[0].window, glm::ivec2(0, 0));
    EXPECT_EQ(wall.tiles[2].outputs[1].window, glm::ivec2(1024, -8));
}

TEST(WallPlace, OfAllMeansEveryTile) {
    const Wall wall = parseWall(wallWith("mono", "[[place]]\ntiles = \"all\"\nhost = \"one\"\n"), "lab.toml");
    ASSERT_EQ(wall.tiles.size(), 5U);
    for (const Tile& tile : wall.tiles) {
        EXPECT_EQ(tile.place.host, "one") << tile.name;
    }
}

TEST(WallPlace, LetsEveryMachineOfAHostFileCallItsMonitorsAlike) {
    // Without a host, mpirun's host file places the ranks, and every machine has a DP-1.
    const Wall wall = parseWall(wallWith("mono", "[[place]]\ntiles = \"all\"\nmonitors = [\"DP-1\"]\n"), "lab.toml");
    EXPECT_EQ(wall.tiles[4].outputs[0].monitor, "DP-1");
    const std::string twice =
        "[[place]]\ntiles = [\"r1c1\"]\nmonitors = [\"DP-1\"]\n"
        "[[place]]\ntiles = [\"r1c2\"]\nmonitors = [\"DP-1\"]\n";
    EXPECT_NE(complaint(wallWith("mono", twice)).find("monitor 'DP-1' would show"), std::string::npos);
}

TEST(WallPlace, TellsDisplaysAndHostsApart) {
    const std::string displays =
        "[[place]]\ntiles = [\"r1c1\"]\ndisplay = \":0.0\"\nmonitors = [\"DP-1\"]\n"
        "[[place]]\ntiles = [\"r1c2\"]\ndisplay = \":0.1\"\nmonitors = [\"DP-1\"]\n";
    EXPECT_EQ(complaint(wallWith("mono", displays)), "no complaint");
    const std::string hosts =
        "[[place]]\ntiles = [\"r1c1\"]\nhost = \"a\"\nwindows = [[0, 0]]\n"
        "[[place]]\ntiles = [\"r1c2\"]\nhost = \"b\"\nwindows = [[0, 0]]\n";
    EXPECT_EQ(complaint(wallWith("mono", hosts)), "no complaint");
    EXPECT_EQ(complaint(wallWith("mono",
                                 "[[place]]\ntiles = [\"r1c1\"]\nwindows = [[0, 0]]\n"
                                 "[[place]]\ntiles = [\"r1c2\"]\nwindows = [[1024, 0]]\n")),
              "no complaint")
        << "side by side, not on one another";
}

TEST(WallPlace, TakesAWindowOfBothEyesForTwiceAsWide) {
    const std::string beside =
        "[[place]]\ntiles = [\"r1c1\"]\nwindows = [[0, 0]]\n"
        "[[place]]\ntiles = [\"r1c2\"]\nwindows = [[1024, 0]]\n";
    EXPECT_NE(complaint(wallWith("side_by_side", beside)).find("(2048x768 pixels) would lie over that of 'r1c1'"),
              std::string::npos);
}

TEST(WallFile, ReadsRefreshAndTracking) {
    const Wall wall = parseWall(wallWith("active", "[tracking]\nsource = \"opentrack:10.0.0.3:4242\"\n"), "lab.toml");
    EXPECT_EQ(wall.refreshHz, 120);
    EXPECT_EQ(wall.tracking, "opentrack:10.0.0.3:4242");
    const Wall plain = config("desktop.toml");
    EXPECT_EQ(plain.refreshHz, 60);
    EXPECT_EQ(plain.tracking, "");
}

TEST(WallFile, KeepsAnOverlapAsANegativeBezel) {
    const Wall wall = parseWall(wallWith("mono", "", "overlap = [0.125, 0.09375]"), "lab.toml");
    EXPECT_EQ(wall.grid->bezel, glm::dvec2(-0.125, -0.09375));
    EXPECT_NEAR(wall.tiles[0].screen.lowerRight.x - wall.tiles[1].screen.lowerLeft.x, 0.125, 1e-12);
    EXPECT_NEAR(wall.tiles[2].screen.upperLeft.y - wall.tiles[0].screen.lowerLeft.y, 0.09375, 1e-12);
    const Canvas canvas = wallCanvas(wall);
    EXPECT_EQ(canvas.tiles[1], (PixelRect{1024 - 128, 0, 1024, 768}));
    EXPECT_EQ(canvas.tiles[2], (PixelRect{0, 768 - 96, 1024, 768}));
}

TEST(WallFile, ShowsTheSamePointWhereTilesOverlap) {
    Wall wall = parseWall(wallWith("passive", "", "overlap = [0.125, 0.09375]"), "lab.toml");
    wall.tiles.pop_back();  // the floor
    const Wall whole = wholeWall(wall);
    EXPECT_EQ(whole.tiles[0].pixels, glm::ivec2(2048 - 128, 1536 - 96));
    const Canvas canvas = wallCanvas(wall);
    const glm::dvec3 point(0.01, 1.02, -0.7);
    for (const Eye eye : eyesOf(wall.stereo)) {
        const glm::dvec2 expected =
            pixelAt({0, 0, canvas.width, canvas.height}, viewOf(whole, whole.tiles[0], eye), point);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_LT(glm::distance(pixelAt(canvas.tiles[i], viewOf(wall, wall.tiles[i], eye), point), expected), 1e-6);
        }
    }
}

TEST(WallFile, TakesScreensThatAreSaidToOverlap) {
    const std::string blend =
        "[[screen]]\nname = \"more\"\nlower_left = [0.5, 0.0, 2.0]\nlower_right = [2.5, 0.0, 2.0]\n"
        "upper_left = [0.5, 0.0, 0.5]\npixels = [1024, 768]\n";
    EXPECT_NE(complaint(wallWith("mono", blend)).find("write overlaps = [\"floor\"]"), std::string::npos);
    EXPECT_EQ(complaint(wallWith("mono", blend + "overlaps = [\"floor\"]\n")), "no complaint");
}

/// Returns the error for two tiles on one monitor of these hosts and displays.
std::string complaintAbout(const std::string& firstPlace, const std::string& secondPlace) {
    return complaint(wallWith("mono", "[[place]]\ntiles = [\"r1c1\"]\nmonitors = [\"DP-1\"]\n" + firstPlace +
                                          "[[place]]\ntiles = [\"r1c2\"]\nmonitors = [\"DP-1\"]\n" + secondPlace));
}

// The name of an X display is [PROTOCOL/][HOST]:NUMBER[.SCREEN]. No host and "unix" mean the machine itself.
TEST(WallPlace, TakesOneDisplayForOneHoweverItIsSpelt) {
    for (const char* display : {":0.0", "unix:0", ":00", "unix:0.0", "unix/:0", ":0.00", "local/:0"}) {
        const std::string line = complaintAbout("display = \":0\"\n", fmt::format("display = \"{}\"\n", display));
        EXPECT_EQ(line, fmt::format("lab.toml:28: monitor 'DP-1' would show output 'r1c2' of tile 'r1c2' and 'r1c1' of "
                                    "line 24 at once (':0' and '{}' are one display): name another monitor, or the "
                                    "host of each",
                                    display));
    }
    EXPECT_NE(complaintAbout("host = \"node1\"\ndisplay = \":0\"\n", "host = \"NODE1\"\ndisplay = \":0.0\"\n")
                  .find("('node1 :0' and 'NODE1 :0.0' are one display)"),
              std::string::npos);
    EXPECT_NE(complaintAbout("host = \"node1\"\n", "host = \"Node1\"\n").find("are one display"), std::string::npos);
    EXPECT_NE(complaintAbout("host = \"node1\"\ndisplay = \":0\"\n", "display = \"node1:0\"\n").find("one display"),
              std::string::npos)
        << "over the network";
    const std::string windows =
        "[[place]]\ntiles = [\"r1c1\"]\ndisplay = \":0\"\nwindows = [[0, 0]]\n"
        "[[place]]\ntiles = [\"r1c2\"]\ndisplay = \"unix:0\"\nwindows = [[8, 0]]\n";
    EXPECT_NE(
        complaint(wallWith("mono", windows)).find("that of 'r1c1' of line 25 (':0' and 'unix:0' are one display)"),
        std::string::npos);
}

TEST(WallPlace, TakesDisplaysThatOnlyLookAlikeForTwo) {
    for (const char* display : {":0.1", ":1", ":10", "unix:0.10", "node2:0", "localhost:0"}) {
        EXPECT_EQ(complaintAbout("display = \":0\"\n", fmt::format("display = \"{}\"\n", display)), "no complaint")
            << display;
    }
    EXPECT_EQ(complaintAbout("host = \"node1\"\ndisplay = \":0\"\n", "host = \"node11\"\ndisplay = \":0.0\"\n"),
              "no complaint");
    EXPECT_EQ(
        complaintAbout("host = \"a\"\ndisplay = \"localhost:10\"\n", "host = \"b\"\ndisplay = \"localhost:10\"\n"),
        "no complaint")
        << "tunnels of two machines";
}

}  // namespace
}  // namespace walls
