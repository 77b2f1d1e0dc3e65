// SPDX-License-Identifier: Apache-2.0
#include "walls/stereo_change.hpp"

#include <gtest/gtest.h>

#include <set>

#include "base/input_error.hpp"

namespace {

using walls::Stereo;

walls::Wall sampleWall(const char* name) {
    return walls::loadWall(std::filesystem::path(SANDWALL_SOURCE_DIR "/walls/configs") / name);
}

/// Returns the modes that the wall's outputs can show.
std::set<std::string> shownBy(const walls::Wall& wall) {
    std::set<std::string> names;
    for (const auto& [stereo, name] : valuesOf(walls::Stereo{})) {
        try {
            const walls::Wall other = walls::shownOnItsOutputs(wall, stereo);
            EXPECT_EQ(other.stereo, stereo);
            EXPECT_EQ(walls::shownOnItsOutputs(wall, wall.stereo), wall) << "and back";
            for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
                EXPECT_EQ(other.tiles[i].outputs.size(), wall.tiles[i].outputs.size());
                EXPECT_EQ(walls::outputPixels(other.stereo, other.tiles[i].pixels),
                          walls::outputPixels(wall.stereo, wall.tiles[i].pixels));
            }
            names.emplace(name);
        } catch (const base::InputError& error) {
            EXPECT_NE(std::string(error.what()).find("--stereo"), std::string::npos) << error.what();
        }
    }
    return names;
}

TEST(StereoChange, OneOutputOfAnEyesSizeShowsEveryModeOfThatSize) {
    const std::set<std::string> all{"mono",         "left",     "right",         "active",         "row_interlaced",
                                    "checkerboard", "anaglyph", "anaglyph_half", "anaglyph_dubois"};
    EXPECT_EQ(shownBy(sampleWall("anaglyph.toml")), all);
    EXPECT_EQ(shownBy(sampleWall("left_only.toml")), all);
}

TEST(StereoChange, AnOutputForEachEyeShowsBothOrOne) {
    const walls::Wall wall = sampleWall("tiled_3x4.toml");
    ASSERT_EQ(wall.stereo, Stereo::passive);
    EXPECT_EQ(shownBy(wall), (std::set<std::string>{"passive", "mono", "left", "right"}));
}

TEST(StereoChange, WhatCannotBeShownIsSaidWithWhatWouldBeNeeded) {
    const auto complaint = [](const char* file, Stereo stereo) {
        try {
            (void)walls::shownOnItsOutputs(sampleWall(file), stereo);
        } catch (const base::InputError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_EQ(complaint("tiled_3x4.toml", Stereo::anaglyphColour),
              "anaglyph needs 1 output per tile, and tile 'r1c1' has 2; this wall can switch to mono, left, right; for "
              "others, end the session and start it with --stereo");
    EXPECT_EQ(walls::otherModesOf(sampleWall("tiled_3x4.toml")), (std::vector<std::string>{"mono", "left", "right"}));
    const std::string wide = complaint("anaglyph.toml", Stereo::sideBySide);
    EXPECT_EQ(wide.find("side_by_side needs frames of "), 0U) << wide;
}

}  // namespace
