// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/input_error.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

const std::string kWall = R"(name = "lab"
[viewer]
eye = [0.0, 1.6, 3.0]
eye_separation = 0.065
[stereo]
mode = "passive"
[grid]
rows = 2
columns = 3
tile_size = [1.0, 0.75]
bezel = [0.01, 0.02]
tile_pixels = [1024, 768]
lower_left = [-1.5, 0.3, 0.0]
[clip]
near = 0.1
far = 50.0
[stage]
centre = [0.0, 1.0, -1.0]
width = 2.0
[[screen]]
name = "floor"
lower_left = [-1.5, 0.0, 2.0]
lower_right = [1.5, 0.0, 2.0]
upper_left = [-1.5, 0.0, 0.0]
pixels = [1500, 1000]
)";

/// Returns the sample with one line replaced. An empty `now` removes the line.
std::string edited(const std::string& was, const std::string& now) {
    std::string text = kWall;
    const std::size_t at = text.find(was + "\n");
    if (at == std::string::npos) {
        throw std::logic_error("no line '" + was + "' in the sample");
    }
    return text.replace(at, was.size(), now);
}

int lineOf(const std::string& line) {
    return 1 + static_cast<int>(
                   std::count(kWall.begin(), kWall.begin() + static_cast<std::ptrdiff_t>(kWall.find(line)), '\n'));
}

TEST(WallFile, NumbersTheGridFirstAndThenTheScreens) {
    const Wall wall = parseWall(kWall, "lab.toml");
    ASSERT_EQ(wall.ranks(), 7);
    for (int rank = 1; rank <= 7; ++rank) {
        EXPECT_EQ(wall.tiles[static_cast<std::size_t>(rank - 1)].rank, rank);
    }
    EXPECT_EQ(wall.tiles[0].name, "r1c1");
    EXPECT_NEAR(wall.tiles[0].screen.lowerLeft.y, 0.3 + 0.75 + 0.02, 1e-12) << "row 1 is at the top";
    EXPECT_EQ(wall.tiles[3].name, "r2c1");
    EXPECT_EQ(wall.tiles[6].name, "floor");
    EXPECT_EQ(wall.tiles[6].row, 0);
}

TEST(WallFile, NamesTheLineOfWhatIsWrong) {
    struct Case {
        std::string was, now, says;
    };
    const std::vector<Case> cases{
        {"eye = [0.0, 1.6, 3.0]", "eye = [0.0, 1.6]", "eye must be a list of 3 finite numbers"},
        {"eye = [0.0, 1.6, 3.0]", "eye = [0.0, 1600.0, 3000.0]", "eye is in metres"},
        {"eye_separation = 0.065", "eye_separation = -0.06", "eye_separation must be positive, got -0.06"},
        {"eye_separation = 0.065", "eye_separation = 65.0", "eye_separation is in metres"},
        {"eye_separation = 0.065", "eye_separaton = 0.065", "unknown key 'eye_separaton'"},
        {"mode = \"passive\"", "mode = \"3d\"",
         "mode must be one of mono, left, right, passive, active, side_by_side, top_bottom, "
         "row_interlaced, checkerboard, anaglyph, anaglyph_half, anaglyph_dubois, got '3d'"},
        {"rows = 2", "rows = 0", "rows must be a whole number within [1, 1024], got 0"},
        {"columns = 3", "columns = 1000", "2000 tiles; a wall has at most 1024"},
        {"tile_size = [1.0, 0.75]", "tile_size = [-1.0, 0.75]", "tile_size must be positive, got -1"},
        {"tile_size = [1.0, 0.75]", "tile_size = [1.0, nan]", "tile_size"},
        {"bezel = [0.01, 0.02]", "bezel = [-0.01, 0.02]", "bezel is in metres and must be within [0, 1000], got -0.01"},
        {"bezel = [0.01, 0.02]", "bezel = [10, 20]", "bezel is in metres and must not exceed the tile"},
        {"tile_pixels = [1024, 768]", "tile_pixels = [1280, 768]", "must be square within 1 %"},
        {"tile_pixels = [1024, 768]", "tile_pixels = [1024.5, 768]", "whole numbers"},
        {"tile_pixels = [1024, 768]", "tile_pixels = [1024, 100000]", "whole numbers within [1, 16384]"},
        {"lower_left = [-1.5, 0.3, 0.0]", "lower_left = [-1.5, 0.3, 4.0]", "is not in front of tile 'r1c1'"},
        {"far = 50.0", "far = 0.05", "far must lie beyond near (0.1 m), got 0.05"},
        {"near = 0.1", "near = 0", "near must be positive, got 0"},
        {"width = 2.0", "width = 0", "width must be positive, got 0"},
        {"width = 2.0", "tilt_deg = 100", "tilt_deg must be within [-90, 90], got 100"},
        {"name = \"floor\"", "name = \"r1c2\"", "two tiles are called 'r1c2'"},
        {"name = \"floor\"", "name = \"../floor\"", "letters, digits"},
        {"upper_left = [-1.5, 0.0, 0.0]", "upper_left = [-1.4, 0.0, 0.0]",
         "must be at right angles, got 87.14 degrees"},
        {"lower_right = [1.5, 0.0, 2.0]", "lower_right = [-1.5, 0.0, 2.0]", "the screen has no size"},
        {"pixels = [1500, 1000]", "pixels = [1500, 1050]", "must be square within 1 %"},
        {"name = \"lab\"", "nam = \"lab\"", "unknown key 'nam'"},
        {"name = \"lab\"", "name = ", ""},
    };
    for (const Case& wrong : cases) {
        // A missing width is reported at the table. All other errors are reported at the line itself.
        const std::string line =
            complaint(edited(wrong.was, wrong.now.rfind("tilt", 0) == 0 ? "width = 2\n" + wrong.now : wrong.now));
        const int expected = lineOf(wrong.was) + (wrong.now.rfind("tilt", 0) == 0 ? 1 : 0);
        EXPECT_EQ(line.rfind("lab.toml:" + std::to_string(expected) + ": ", 0), 0U) << wrong.now << "\n" << line;
        EXPECT_NE(line.find(wrong.says), std::string::npos) << wrong.now << "\n" << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
}

TEST(WallFile, NamesAScreenGivenFromTheWrongSide) {
    // Left and right are exchanged, so that the screen faces away from the viewer.
    std::string text = edited("lower_left = [-1.5, 0.0, 2.0]", "lower_left = [1.5, 0.0, 2.0]");
    text.replace(text.find("lower_right = [1.5, 0.0, 2.0]"), 29, "lower_right = [-1.5, 0.0, 2.0]");
    text.replace(text.find("upper_left = [-1.5, 0.0, 0.0]"), 29, "upper_left = [1.5, 0.0, 0.0]");
    EXPECT_NE(complaint(text).find("as the viewer sees them"), std::string::npos) << complaint(text);
}

TEST(WallFile, NamesWhatIsMissing) {
    EXPECT_NE(complaint("name = \"lab\"\n").find("a table [viewer] is missing"), std::string::npos);
    const std::string bare = "[viewer]\neye = [0, 0, 1]\n[stage]\ncentre = [0, 0, 0]\nwidth = 1\n";
    EXPECT_NE(complaint(bare).find("the wall has no tile"), std::string::npos) << complaint(bare);
    EXPECT_NE(complaint(edited("rows = 2", "")).find("needs a whole number 'rows'"), std::string::npos);
}

TEST(WallFile, SquaresCornersThatATapeMeasureLeftAMillimetreOff) {
    const Wall wall = parseWall(edited("upper_left = [-1.5, 0.0, 0.0]", "upper_left = [-1.498, 0.0, 0.0]"), "lab.toml");
    const Screen& floor = wall.tiles[6].screen;
    EXPECT_NEAR(glm::dot(floor.right(), floor.up()), 0, 1e-15);
    EXPECT_NEAR(floor.height(), 2, 1e-5);
}

TEST(WallFile, TakesAGridThatIsTurnedInTheRoom) {
    std::string text = edited("lower_left = [-1.5, 0.3, 0.0]", "lower_left = [-3.0, 0.3, 1.5]\nright = [0, 0, -2]");
    const Wall wall = parseWall(text, "lab.toml");
    EXPECT_LT(glm::distance(wall.tiles[0].screen.normal(), {1, 0, 0}), 1e-12);
    EXPECT_NEAR(wall.tiles[0].screen.width(), 1, 1e-12) << "directions need no length";
}

TEST(WallFile, FallsBackToMonoAndTheFilesName) {
    std::string text = edited("name = \"lab\"", "");
    text.replace(text.find("[stereo]\nmode = \"passive\"\n"), 26, "");
    const Wall wall = parseWall(text, "walls/lab.toml");
    EXPECT_EQ(wall.name, "lab");
    EXPECT_EQ(wall.stereo, Stereo::mono);
}

}  // namespace
}  // namespace walls
