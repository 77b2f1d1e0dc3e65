// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_units.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/processes/run_program.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

/// Returns a monitor of 0.531 m x 0.299 m on a desk. Its lengths are in a unit, and `scale` units are a metre.
std::string deskIn(double scale) {
    return fmt::format(
        "name = \"desk\"\n[viewer]\neye = [0, 0, {:.6g}]\n[grid]\nrows = 1\ncolumns = 1\n"
        "tile_size = [{:.6g}, {:.6g}]\ntile_pixels = [1280, 720]\nlower_left = [{:.6g}, {:.6g}, 0]\n"
        "[stage]\ncentre = [0, {:.6g}, {:.6g}]\nwidth = {:.6g}\ntilt_deg = 35\n",
        0.65 * scale, 0.531 * scale, 0.299 * scale, -0.2655 * scale, -0.1495 * scale, -0.02 * scale, -0.158 * scale,
        0.46 * scale);
}

std::vector<std::string> warningsOf(const Wall& wall) {
    std::vector<std::string> lines = unitWarnings(wall);
    if (const auto line = stageWarning(wall)) {
        lines.push_back(*line);
    }
    return lines;
}
std::vector<std::string> warningsOf(const std::string& text) { return warningsOf(parseWall(text, "desk.toml")); }

TEST(WallUnits, WarnOfNoSampleAndOfNoWallInMetres) {
    for (const std::string& name : configNames()) {
        EXPECT_TRUE(warningsOf(config(name)).empty()) << name << ": " << warningsOf(config(name)).front();
    }
    EXPECT_TRUE(warningsOf(deskIn(1)).empty());
}

// The monitor's pixels are 0.531 m / 1280 = 0.415 mm wide. The near edge of the sand is 0.46 / 2 · cos 35° = 0.188 m in
// front of its centre, so 0.65 + 0.158 - 0.188 = 0.620 m from the eye. In millimetres that is 620 m, beyond far.
TEST(WallUnits, WarnOfMillimetres) {
    const std::vector<std::string> lines = warningsOf(deskIn(1000));
    ASSERT_EQ(lines.size(), 3U) << fmt::format("{}", fmt::join(lines, "\n"));
    EXPECT_EQ(lines[0].find("a pixel of tile 'r1c1' is 415 mm wide"), 0U) << lines[0];
    EXPECT_EQ(lines[1].find("the sand is 619.6 m from the eye, beyond far (100 m)"), 0U) << lines[1];
    EXPECT_EQ(lines[2].find("no tile shows a corner of the sand"), 0U) << lines[2];
    for (const std::string& line : lines) {
        EXPECT_NE(line.find("all lengths of a wall file are in metres"), std::string::npos) << line;
    }
}

// In centimetres everything is within far, and only the pixels of 41 mm tell.
TEST(WallUnits, WarnOfCentimetres) {
    const std::vector<std::string> lines = warningsOf(deskIn(100));
    ASSERT_EQ(lines.size(), 1U) << fmt::format("{}", fmt::join(lines, "\n"));
    EXPECT_EQ(lines[0].find("a pixel of tile 'r1c1' is 41 mm wide"), 0U) << lines[0];
}

TEST(WallUnits, TakeAPixelOfTwentyMillimetresForALedWall) {
    Wall wall = parseWall(deskIn(1), "desk.toml");
    const auto widen = [&wall](double side) {
        Tile& tile = wall.tiles[0];
        tile.screen = {{0, 0, 0}, {side * tile.pixels.x, 0, 0}, {0, side * tile.pixels.y, 0}};
        const std::vector<std::string> lines = unitWarnings(wall);
        return !lines.empty() && lines[0].starts_with("a pixel of tile");
    };
    EXPECT_FALSE(widen(0.0199));
    EXPECT_TRUE(widen(0.0201));
}

TEST(WallUnits, WarnOfAStageThatIsMovedAway) {
    Wall wall = parseWall(deskIn(1), "desk.toml");
    wall.stage.centre.x = 5;
    ASSERT_EQ(warningsOf(wall).size(), 1U);
    EXPECT_EQ(warningsOf(wall)[0].find("no tile shows a corner of the sand"), 0U);
    wall.stage.centre = {0, 0, -200};
    ASSERT_FALSE(unitWarnings(wall).empty());
    EXPECT_NE(unitWarnings(wall)[0].find("beyond far (100 m)"), std::string::npos) << unitWarnings(wall)[0];
    wall.clip.far = 1000;
    for (const std::string& line : unitWarnings(wall)) {
        EXPECT_EQ(line.find("beyond far"), std::string::npos) << line;
    }
}

TEST(WallUnits, AreWarnedOfByTheProgramWhichStillSucceeds) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "sandwall_in_millimetres.toml";
    std::ofstream(file) << deskIn(1000);
    const support::Ran ran = support::runProgram("sandwall-check", file.string());
    EXPECT_EQ(ran.status, 0);
    EXPECT_NE(ran.output.find("\nwarning: a pixel of tile 'r1c1' is 415 mm wide"), std::string::npos) << ran.output;
    EXPECT_EQ(support::runProgram("sandwall-check", file.string() + " --ranks").output, "1\n") << "for programs";
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace walls
