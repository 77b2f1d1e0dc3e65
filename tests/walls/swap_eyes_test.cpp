// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include "base/field_forms.hpp"
#include "tests/walls/sample_walls.hpp"
#include "walls/stereo_change.hpp"
#include "walls/wall_report.hpp"

namespace walls {
namespace {

/// Returns the eyes of a tile's outputs, one list for each output.
std::vector<std::vector<Eye>> eyesShown(const Wall& wall) {
    std::vector<std::vector<Eye>> eyes;
    for (const Output& output : wall.tiles.front().outputs) {
        eyes.push_back(output.eyes);
    }
    return eyes;
}

using Eyes = std::vector<std::vector<Eye>>;
constexpr Eye kLeft = Eye::left, kRight = Eye::right;

TEST(SwapEyes, ExchangesTheEyesOfEveryModeWithTwo) {
    for (const auto& mode : valuesOf(Stereo{})) {
        const Wall wall = shownIn(config("anaglyph.toml"), mode.value);
        const Wall swapped = withSwappedEyes(wall, true);
        if (mode.value == Stereo::passive) {
            EXPECT_EQ(eyesShown(swapped), (Eyes{{kRight}, {kLeft}}));
        } else if (eyesOf(mode.value).size() == 2) {
            EXPECT_EQ(eyesShown(swapped), (Eyes{{kRight, kLeft}})) << mode.name;
        } else {
            EXPECT_EQ(eyesShown(swapped), eyesShown(wall)) << mode.name << " shows one picture";
        }
        EXPECT_EQ(withSwappedEyes(swapped, true), swapped) << mode.name;
        EXPECT_EQ(withSwappedEyes(swapped, false), wall) << mode.name;
    }
}

TEST(SwapEyes, KeepsTheNamesMonitorsAndWindowsOfOutputs) {
    Wall wall = shownIn(config("tiled_3x4.toml"), Stereo::passive);
    wall.tiles[0].outputs[0].monitor = "DP-1";
    wall.tiles[0].outputs[1].window = glm::ivec2(7, 8);
    const Wall swapped = withSwappedEyes(wall, true);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(swapped.tiles[0].outputs[i].name, wall.tiles[0].outputs[i].name);
        EXPECT_EQ(swapped.tiles[0].outputs[i].monitor, wall.tiles[0].outputs[i].monitor);
        EXPECT_EQ(swapped.tiles[0].outputs[i].window, wall.tiles[0].outputs[i].window);
    }
}

// The glasses stay exchanged while an operator looks at one eye.
TEST(SwapEyes, IsKeptInOtherModes) {
    const Wall wall = withSwappedEyes(config("anaglyph.toml"), true);
    const Wall mono = shownOnItsOutputs(wall, Stereo::mono);
    EXPECT_TRUE(mono.swapEyes);
    EXPECT_EQ(eyesShown(shownOnItsOutputs(wall, Stereo::rowInterlaced)), (Eyes{{kRight, kLeft}}));
    EXPECT_EQ(eyesShown(shownIn(mono, Stereo::passive)), (Eyes{{kRight}, {kLeft}}));
}

TEST(SwapEyes, IsReadFromTheWallFile) {
    const auto wallWith = [](const std::string& stereo) {
        return "[viewer]\neye = [0, 0, 1]\n[stereo]\n" + stereo +
               "[grid]\nrows = 1\ncolumns = 1\ntile_size = [0.4, 0.3]\ntile_pixels = [640, 480]\n"
               "lower_left = [-0.2, -0.15, 0]\n[stage]\ncentre = [0, 0, -0.1]\nwidth = 0.3\n";
    };
    const Wall wall = parseWall(wallWith("mode = \"passive\"\nswap_eyes = true\n"), "lab.toml");
    EXPECT_TRUE(wall.swapEyes);
    EXPECT_EQ(eyesShown(wall), (Eyes{{kRight}, {kLeft}}));
    EXPECT_EQ(wall, withSwappedEyes(parseWall(wallWith("mode = \"passive\"\n"), "lab.toml"), true));
    EXPECT_FALSE(parseWall(wallWith("mode = \"mono\"\nswap_eyes = false\n"), "lab.toml").swapEyes);
    EXPECT_EQ(complaint(wallWith("mode = \"right\"\nswap_eyes = true\n")),
              "lab.toml:5: swap_eyes needs a mode with two eyes, and right draws one: choose another mode, or leave "
              "swap_eyes out");
    EXPECT_EQ(complaint(wallWith("mode = \"passive\"\nswap_eyes = 1\n")),
              "lab.toml:5: swap_eyes must be true or false, without quotation marks");
}

TEST(SwapEyes, IsPrintedByTheCheck) {
    const std::string text = describe(withSwappedEyes(config("tiled_3x4.toml"), true));
    EXPECT_NE(text.find("passive stereo with swapped eyes"), std::string::npos) << text.substr(0, 300);
    EXPECT_NE(text.find("r1c1_left r"), std::string::npos);
}

TEST(SwapEyes, IsInTheBytesOfAWall) {
    const Wall wall = withSwappedEyes(config("tiled_3x4.toml"), true);
    EXPECT_EQ(Wall::decode(wall.encode()), wall);
    Wall odd = wall;
    odd.swapEyes = false;  // the outputs are still swapped
    EXPECT_THROW((void)Wall::decode(odd.encode()), base::FormatError);
}

}  // namespace
}  // namespace walls
