// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/files/wall_text.hpp"
#include "tests/support/processes/run_program.hpp"
#include "tests/walls/sample_walls.hpp"
#include "walls/wall_map.hpp"
#include "walls/wall_measure.hpp"
#include "walls/wall_report.hpp"
#include "walls/wall_svg.hpp"

namespace walls {
namespace {

std::string pathOf(const std::string& name) { return (configFolder() / name).string(); }

std::size_t countOf(const std::string& what, const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) {
        ++count;
    }
    return count;
}

TEST(CheckProgram, ExitsWithTwoAndOneLineForWhatItCannotUse) {
    for (const std::string& arguments :
         {std::string("no/such/wall.toml"), std::string(""), std::string("--what"), configFolder().string(),
          std::string(SANDWALL_SOURCE_DIR "/LICENSE"), pathOf("desktop.toml") + " --stereo 3d",
          pathOf("desktop.toml") + " --mono --stereo left", pathOf("desktop.toml") + " --ranks --hosts",
          pathOf("desktop.toml") + " --svg /no/such/folder/wall.svg"}) {
        const support::Ran ran = support::runProgram("sandwall-check", arguments);
        EXPECT_EQ(ran.status, 2) << arguments;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    }
}

TEST(CheckProgram, CountsOutputsAndThoseWithAPlace) {
    for (const auto& [arguments, line] : {std::pair{"desktop.toml", "1 0\n"},
                                          {"tiled_3x4.toml", "24 0\n"},
                                          {"desktop.toml --stereo passive", "2 0\n"}}) {
        EXPECT_EQ(support::runProgram("sandwall-check", pathOf(arguments) + " --outputs").output, line) << arguments;
    }
    Wall wall = loadWallAs(pathOf("tiled_3x4.toml"), "");
    wall.tiles[0].place.display = ":0";               // both outputs of the tile
    wall.tiles[1].outputs[0].monitor = "HDMI-1";      // one of them
    wall.tiles[2].outputs[1].window = glm::ivec2(0);  // one of them
    EXPECT_EQ(outputsLine(wall), "24 4\n");
}

TEST(CheckProgram, ShowsAnyWallInAnyMode) {
    for (const std::string& name : configNames()) {
        for (const auto& [stereo, mode] : valuesOf(Stereo{})) {
            const std::string text = describe(loadWallAs(pathOf(name), std::string(mode)));
            const bool mono = stereo == Stereo::mono;
            EXPECT_NE(text.find(mono ? ", mono," : fmt::format(", {} stereo,", mode)), std::string::npos)
                << name << "\n"
                << text;
        }
    }
    const support::Ran ran = support::runProgram("sandwall-check", pathOf("desktop.toml") + " --stereo top_bottom");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_EQ(ran.output, describe(loadWallAs(pathOf("desktop.toml"), "top_bottom")));
}

TEST(CheckProgram, AsksForTheEyesThatAnotherModeDraws) {
    // The head is 2 cm in front of the right screen: enough for mono, but too little for a right eye.
    Wall cave = shownIn(config("flex_cave.toml"), Stereo::mono);
    cave.viewer.eye.x = 1.58;
    const std::string file = testing::TempDir() + "near_" + std::to_string(::getpid()) + ".toml";
    std::ofstream(file) << support::wallText(cave);
    EXPECT_EQ(support::runProgram("sandwall-check", file).status, 0);
    const support::Ran ran = support::runProgram("sandwall-check", file + " --stereo active");
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.output.find("shown in active: the right eye"), std::string::npos) << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    std::filesystem::remove(file);
}

TEST(CheckProgram, PrintsTheHostOfEachRank) {
    Wall wall = config("flex_cave.toml");
    wall.tiles[0].place.host = "node1";
    wall.tiles[3].place.host = "10.0.0.4";
    const std::string file = testing::TempDir() + "hosts_" + std::to_string(::getpid()) + ".toml";
    std::ofstream(file) << support::wallText(wall);
    const support::Ran ran = support::runProgram("sandwall-check", file + " --hosts");
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.output, "node1\n-\n-\n10.0.0.4\n");
    std::filesystem::remove(file);
}

TEST(CheckProgram, SaysWhatItMeasured) {
    const support::Ran tiled = support::runProgram("sandwall-check", pathOf("tiled_3x4.toml"));
    EXPECT_NE(tiled.output.find("12 for the tiles; with the master, 13 processes"), std::string::npos);
    EXPECT_NE(tiled.output.find("left and right on every tile, 24 outputs"), std::string::npos);
    EXPECT_NE(tiled.output.find("measured 9 across of 10.0 mm, 8 down of 10.0 mm"), std::string::npos);
    const support::Ran cave = support::runProgram("sandwall-check", pathOf("flex_cave.toml"));
    EXPECT_EQ(countOf("0.0 mm apart, at 90.0 degrees", cave.output), 5U) << cave.output;
    const support::Ran television = support::runProgram("sandwall-check", pathOf("top_bottom.toml"));
    EXPECT_NE(television.output.find("twice as high as wide"), std::string::npos) << television.output;
    EXPECT_NE(television.output.find("r1c1 l r 1920x1080"), std::string::npos) << television.output;
}

TEST(Measures, FindTilesThatAreNotWhereTheGridSays) {
    Wall wall = config("tiled_3x4.toml");
    wall.tiles[5].screen.lowerLeft.x += 0.001;
    wall.tiles[5].screen.upperLeft.x += 0.001;
    const auto [across, down] = gapsOf(wall);
    EXPECT_EQ(across.count, 9);
    EXPECT_EQ(down.count, 8);
    EXPECT_NEAR(across.most, 0.011, 1e-12);
    EXPECT_NEAR(across.least, 0.010, 1e-12);
    EXPECT_NEAR(down.aslant, 0.001, 1e-12);
}

TEST(Measures, TellTheAngleAndTheGapOfScreensThatJoin) {
    Wall wall = config("flex_cave.toml");
    wall.tiles.resize(2);
    Screen& front = wall.tiles[1].screen;
    for (glm::dvec3* corner : {&front.lowerLeft, &front.lowerRight, &front.upperLeft}) {
        corner->x += 0.02;
    }
    ASSERT_EQ(seamsOf(wall).size(), 1U);
    const Seam seam = seamsOf(wall)[0];
    EXPECT_EQ(seam.edgeOfFirst, Edge::right);
    EXPECT_EQ(seam.edgeOfSecond, Edge::left);
    EXPECT_NEAR(seam.apart, 0.02, 1e-12);
    EXPECT_NEAR(seam.degrees, 90, 1e-9);
    for (glm::dvec3* corner : {&front.lowerLeft, &front.lowerRight, &front.upperLeft}) {
        corner->x += 0.04;
    }
    EXPECT_TRUE(seamsOf(wall).empty()) << "6 cm apart";
}

TEST(TextMap, UnfoldsACave) {
    EXPECT_EQ(textMap(config("flex_cave.toml")),
              "  +---------++---------++---------+\n"
              "  | 1 left  || 2 front || 3 right |\n"
              "  +---------++---------++---------+\n"
              "             +---------+\n"
              "             | 4 floor |\n"
              "             +---------+\n");
}

TEST(TextMap, HasABoxForEveryTileOfAGrid) {
    EXPECT_EQ(textMap(config("tiled_3x4.toml")),
              "  +------+------+------+------+\n"
              "  |  1   |  2   |  3   |  4   |\n"
              "  +------+------+------+------+\n"
              "  |  5   |  6   |  7   |  8   |\n"
              "  +------+------+------+------+\n"
              "  |  9   |  10  |  11  |  12  |\n"
              "  +------+------+------+------+\n");
}

/// Returns the 2 x 3 grid of a wall whose rows lead into the direction `right` of the room, above it `up`.
Wall turnedGrid(glm::dvec3 right, glm::dvec3 up) {
    Wall wall = config("tiled_3x4.toml");
    wall.grid->rows = 2;
    wall.grid->columns = 3;
    wall.grid->right = right;
    wall.grid->up = up;
    wall.tiles = tilesOf(*wall.grid, wall.stereo);
    return wall;
}

TEST(TextMap, ShowsATurnedGridAsTheViewerSeesIt) {
    const std::string rule2 = "  +------+------+\n", rule3 = "  +------+------+------+\n";
    EXPECT_EQ(textMap(turnedGrid({0, 1, 0}, {-1, 0, 0})),
              rule2 + "  |  3   |  6   |\n" + rule2 + "  |  2   |  5   |\n" + rule2 + "  |  1   |  4   |\n" + rule2 +
                  "  the grid is turned by 90 degrees counter-clockwise\n");
    EXPECT_EQ(textMap(turnedGrid({0, -1, 0}, {1, 0, 0})), rule2 + "  |  4   |  1   |\n" + rule2 +
                                                              "  |  5   |  2   |\n" + rule2 + "  |  6   |  3   |\n" +
                                                              rule2 + "  the grid is turned by 90 degrees clockwise\n");
    EXPECT_EQ(textMap(turnedGrid({-1, 0, 0}, {0, -1, 0})),
              rule3 + "  |  6   |  5   |  4   |\n" + rule3 + "  |  3   |  2   |  1   |\n" + rule3 +
                  "  the grid is turned by 180 degrees counter-clockwise\n");
    const double c = std::cos(0.35), s = std::sin(0.35);  // 20 degrees
    EXPECT_EQ(textMap(turnedGrid({c, s, 0}, {-s, c, 0})), rule3 + "  |  1   |  2   |  3   |\n" + rule3 +
                                                              "  |  4   |  5   |  6   |\n" + rule3 +
                                                              "  the grid is turned by 20 degrees counter-clockwise\n");
}

TEST(TextMap, UnfoldsTurnedScreensAsTheViewerSeesThem) {
    Wall wall = config("flex_cave.toml");
    for (Tile& tile : wall.tiles) {  // the whole room, turned by a quarter about the direction of view
        const auto turned = [](glm::dvec3 p) { return glm::dvec3(-p.y, p.x, p.z); };
        tile.screen = {turned(tile.screen.lowerLeft), turned(tile.screen.lowerRight), turned(tile.screen.upperLeft)};
    }
    EXPECT_EQ(textMap(wall),
              "  +---------+\n"
              "  | 3 right |\n"
              "  +---------+\n"
              "  +---------++---------+\n"
              "  | 2 front || 4 floor |\n"
              "  +---------++---------+\n"
              "  +---------+\n"
              "  | 1 left  |\n"
              "  +---------+\n"
              "  left is turned by 90 degrees counter-clockwise\n"
              "  front is turned by 90 degrees counter-clockwise\n"
              "  right is turned by 90 degrees counter-clockwise\n"
              "  floor is turned by 90 degrees counter-clockwise\n");
}

TEST(TextMap, FollowsTheTurnOfEachScreen) {
    Wall wall = config("flex_cave.toml");
    wall.tiles.resize(3);
    // Three squares side by side. The monitor in the middle stands on its left edge.
    wall.tiles[0].screen = {{-1.5, 1, 0}, {-0.5, 1, 0}, {-1.5, 2, 0}};
    wall.tiles[1].screen = {{0.5, 1, 0}, {0.5, 2, 0}, {-0.5, 1, 0}};
    wall.tiles[2].screen = {{0.5, 1, 0}, {1.5, 1, 0}, {0.5, 2, 0}};
    const std::string rule = "  +---------++---------++---------+\n";
    EXPECT_EQ(textMap(wall), rule + "  | 1 left  || 2 front || 3 right |\n" + rule +
                                 "  front is turned by 90 degrees counter-clockwise\n");
}

TEST(TextMap, ShowsALevelScreenBehindTheViewerAsLevel) {
    Wall wall = config("flex_cave.toml");
    wall.tiles.resize(1);
    const glm::dvec3 eye = wall.viewer.eye;
    wall.tiles[0].screen = {eye + glm::dvec3{1, -1, 2}, eye + glm::dvec3{-1, -1, 2}, eye + glm::dvec3{1, 1, 2}};
    EXPECT_EQ(textMap(wall).find("turned"), std::string::npos) << textMap(wall);
}

TEST(Report, NamesTheModesToWhichTheWallCanSwitch) {
    EXPECT_NE(
        describe(config("tiled_3x4.toml")).find("\nstereo: during a session it can switch to mono, left, right\n"),
        std::string::npos);
    EXPECT_NE(describe(config("desktop.toml")).find("\nstereo: during a session it can switch to "), std::string::npos);
}

TEST(Drawing, HasEveryTileAndTheSandInBothViews) {
    for (const std::string& name : configNames()) {
        const Wall wall = config(name);
        const std::string svg = drawingOf(wall);
        EXPECT_EQ(svg.rfind("<?xml", 0), 0U);
        EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
        for (const Tile& tile : wall.tiles) {
            EXPECT_NE(svg.find(fmt::format(">{} {}<", tile.rank, tile.name)), std::string::npos) << name;
        }
        EXPECT_EQ(countOf(">sand<", svg), 2U) << name;
        EXPECT_EQ(countOf(">viewer<", svg), 2U) << name;
        EXPECT_EQ(svg.find("nan"), std::string::npos) << name;
        EXPECT_EQ(svg.find("inf"), std::string::npos) << name;
    }
}

TEST(Drawing, GivesBezelsAndSizesInFigures) {
    const std::string svg = drawingOf(config("tiled_3x4.toml"));
    EXPECT_EQ(countOf(">gap 10.0 mm<", svg), 2U);
    EXPECT_EQ(countOf(">4.126 m<", svg), 1U);
    EXPECT_EQ(countOf(">2.324 m<", svg), 1U);
    EXPECT_EQ(countOf(">3.000 m<", svg), 1U) << "from the viewer to the wall";
    EXPECT_EQ(countOf(">0.300 m<", svg), 1U) << "above the floor";
}

// A tile that is seen edge on is a thick line. Its name is 36 pixels beside the line, or 14 above or below it. The
// letters are 4 pixels above their base line in the middle.
TEST(Drawing, NamesATileThatIsSeenEdgeOnBesideItsLine) {
    const std::string svg = drawingOf(config("flex_cave.toml"));
    const std::string begin = "<polygon points=\"", end = "stroke-width=\"3\"/>\n<text x=\"", next = "\" y=\"";
    int named = 0;
    for (std::size_t at = svg.find(end); at != std::string::npos; at = svg.find(end, at + 1), ++named) {
        std::istringstream corners(svg.substr(svg.rfind(begin, at) + begin.size(), 100));
        std::array<glm::dvec2, 3> corner{};
        for (glm::dvec2& one : corner) {
            char comma = 0;
            corners >> one.x >> comma >> one.y;
        }
        const glm::dvec2 middle = (corner[0] + corner[2]) / 2.0;
        const double x = std::stod(svg.substr(at + end.size(), 20));
        const double y = std::stod(svg.substr(svg.find(next, at + end.size()) + next.size(), 20));
        EXPECT_NEAR(glm::length(glm::dvec2((x - middle.x) / 36, (y - 4 - middle.y) / 14)), 1, 1e-3) << x << ' ' << y;
    }
    EXPECT_EQ(named, 6) << "left, right and floor in the front view; left, right and front in the plan";
}

TEST(Drawing, WritesNamesThatMeanSomethingInXml) {
    Wall wall = config("desktop.toml");
    wall.name = "R&D <wall>";
    EXPECT_NE(drawingOf(wall).find(">R&amp;D &lt;wall&gt;<"), std::string::npos);
}

TEST(Drawing, GoesIntoAFile) {
    const std::string file = testing::TempDir() + "wall_" + std::to_string(::getpid()) + ".svg";
    const support::Ran ran = support::runProgram("sandwall-check", pathOf("desktop.toml") + " --svg " + file);
    EXPECT_EQ(ran.status, 0) << ran.output;
    std::ifstream stream(file);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(text, drawingOf(config("desktop.toml")));
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace walls
