// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <locale>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "tests/support/processes/run_program.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

/// Returns a corner of the field of sand in the room. The field is taken as square.
glm::dvec3 sandCorner(const Wall& wall, int east, int north) {
    return glm::dvec3(stageToRoom(wall.stage, 1, 1, 0) * glm::dvec4(east, north, 0, 1));
}

TEST(WallConfigs, TiledWallIsThePapers) {
    const Wall wall = config("tiled_3x4.toml");
    EXPECT_EQ(wall.ranks(), 12);
    EXPECT_EQ(wall.stereo, Stereo::passive);
    const Tile& tile = wall.tiles[6];
    EXPECT_EQ(tile.rank, 7);
    EXPECT_EQ(tile.name, "r2c3");
    EXPECT_EQ(tile.row, 2);
    EXPECT_EQ(tile.column, 3);
    EXPECT_EQ(tile.pixels, glm::ivec2(1024, 768));
    ASSERT_EQ(tile.outputs.size(), 2U);
    EXPECT_EQ(tile.outputs[0], (Output{"r2c3_left", {Eye::left}, {}, {}}));
    EXPECT_EQ(tile.outputs[1], (Output{"r2c3_right", {Eye::right}, {}, {}}));
}

TEST(WallConfigs, TilesStandABezelApart) {
    const Wall wall = config("tiled_3x4.toml");
    for (const Tile& tile : wall.tiles) {
        if (tile.column < 4) {
            const Tile& next = wall.tiles[static_cast<std::size_t>(tile.rank)];
            EXPECT_NEAR(next.screen.lowerLeft.x - tile.screen.lowerRight.x, 0.010, 1e-12);
        }
        if (tile.row < 3) {
            const Tile& below = wall.tiles[static_cast<std::size_t>(tile.rank + 3)];
            EXPECT_NEAR(tile.screen.lowerLeft.y - below.screen.upperLeft.y, 0.010, 1e-12);
        }
    }
}

TEST(WallConfigs, FlexShowsBothEyesInTurnOnFourScreens) {
    const Wall wall = config("flex_cave.toml");
    EXPECT_EQ(wall.ranks(), 4);
    EXPECT_EQ(wall.stereo, Stereo::active);
    EXPECT_EQ(wall.tiles[3].outputs, (std::vector<Output>{{"floor", {Eye::left, Eye::right}, {}, {}}}));
    EXPECT_LT(glm::distance(wall.tiles[3].screen.normal(), {0, 1, 0}), 1e-12) << "the floor faces up";
}

TEST(WallConfigs, DesktopIsOneMonoRank) {
    const Wall wall = config("desktop.toml");
    EXPECT_EQ(wall.ranks(), 1);
    EXPECT_EQ(wall.tiles[0].outputs, (std::vector<Output>{{"r1c1", {Eye::middle}, {}, {}}}));
}

/// Calls `check` with the name, the wall and the whole screen of each flat sample. Fails if there is no flat sample.
void forEachFlatWall(const std::function<void(const std::string&, const Wall&, const Screen&)>& check) {
    int flat = 0;
    for (const std::string& name : configNames()) {
        SCOPED_TRACE(name);
        const Wall wall = config(name);
        if (const std::optional<Screen> whole = wholeOfFlat(wall)) {
            check(name, wall, *whole);
            ++flat;
        }
    }
    EXPECT_GT(flat, 0);
}

TEST(WallConfigs, TheSandFillsMostOfAWallAndNoneOfItFallsOff) {
    forEachFlatWall([](const std::string& name, const Wall& wall, const Screen& whole) {
        for (const Eye eye : eyesOf(wall.stereo)) {
            const View view = viewOf(whole, eyePosition(wall.viewer, eye), wall.clip.near, wall.clip.far);
            glm::dvec2 lowest(2), highest(-2);
            for (int corner = 0; corner < 4; ++corner) {
                const glm::dvec4 clip = view.viewProjection * glm::dvec4(sandCorner(wall, corner % 2, corner / 2), 1);
                lowest = glm::min(lowest, glm::dvec2(clip) / clip.w);
                highest = glm::max(highest, glm::dvec2(clip) / clip.w);
                EXPECT_LT(std::abs(clip.z), clip.w) << name << ": clipped";
            }
            EXPECT_GT(std::min(lowest.x, lowest.y), -1) << name;
            EXPECT_LT(std::max(highest.x, highest.y), 1) << name;
            EXPECT_GT((highest - lowest).x, 2 * 0.8) << name << ": of the picture's width";
            EXPECT_GT((highest - lowest).y, 2 * 0.7) << name << ": of the picture's height";
        }
    });
}

TEST(WallConfigs, ShowTheBoxOfLevelSandWithAllItsBoards) {
    forEachFlatWall([](const std::string&, const Wall& wall, const Screen&) {
        expectShown(wall, stageToRoom(wall.stage, 1, 1, 0), shapes::boxOutline({1, 1}, 0, 0));
    });
}

TEST(WallConfigs, TheSandStandsPartlyBeforeAndPartlyBehindTheWall) {
    forEachFlatWall([](const std::string& name, const Wall& wall, const Screen& whole) {
        EXPECT_GT(whole.distanceTo(sandCorner(wall, 0, 0)), 0) << name;
        EXPECT_LT(whole.distanceTo(sandCorner(wall, 0, 1)), 0) << name;
    });
}

TEST(WallConfigs, ShowStereoInEveryWayThereIs) {
    std::set<Stereo> shown;
    for (const std::string& name : configNames()) {
        shown.insert(config(name).stereo);
    }
    EXPECT_EQ(shown.size(), valuesOf(walls::Stereo{}).size());
}

TEST(WallConfigs, PortableHasOneBufferForBothEyes) {
    const Wall wall = config("portable.toml");
    EXPECT_EQ(wall.stereo, Stereo::sideBySide);
    ASSERT_EQ(wall.tiles[0].outputs.size(), 1U) << "one buffer, one swap";
    EXPECT_EQ(wall.tiles[0].outputs[0].eyes, (std::vector<Eye>{Eye::left, Eye::right}));
    EXPECT_EQ(wall.tiles[0].pixels, glm::ivec2(1024, 768));
    EXPECT_EQ(outputPixels(wall.stereo, wall.tiles[0].pixels), glm::ivec2(2048, 768));
}

TEST(WallConfigs, ProjectionScreenIsOneTileForTwoProjectors) {
    const Wall wall = config("projection_screen.toml");
    EXPECT_EQ(wall.stereo, Stereo::passive);
    ASSERT_EQ(wall.ranks(), 1);
    EXPECT_EQ(wall.tiles[0].outputs[0], (Output{"screen_left", {Eye::left}, {}, glm::ivec2(0, 0)}));
    EXPECT_EQ(wall.tiles[0].outputs[1], (Output{"screen_right", {Eye::right}, {}, glm::ivec2(1024, 0)}));
}

TEST(WallConfigs, FishTankFollowsTheHeadAndShowsTheEyesInTurn) {
    const Wall wall = config("fish_tank.toml");
    EXPECT_EQ(wall.stereo, Stereo::active);
    EXPECT_EQ(wall.refreshHz, 120);
    EXPECT_EQ(wall.tracking, "opentrack:4242");
    EXPECT_EQ(wall.ranks(), 1);
}

TEST(WallConfigs, LeftOnlyAndRightOnlyAreTheHalvesOfTheProjectionScreen) {
    const Wall both = config("projection_screen.toml");
    for (const auto& [name, eye] : {std::pair{"left_only.toml", Eye::left}, {"right_only.toml", Eye::right}}) {
        const Wall one = config(name);
        EXPECT_EQ(one.viewer, both.viewer);
        EXPECT_EQ(one.stage, both.stage);
        EXPECT_EQ(one.tiles[0].screen, both.tiles[0].screen);
        EXPECT_EQ(one.tiles[0].outputs, (std::vector<Output>{{"screen", {eye}, {}, {}}}));
    }
}

TEST(WallConfigs, EveryFileLoadsAndPassesTheCheck) {
    for (const std::string& name : configNames()) {
        const std::string file = (configFolder() / name).string();
        const Wall wall = loadWall(file);
        const support::Ran check = support::runProgram("sandwall-check", file);
        EXPECT_EQ(check.status, 0) << check.output;
        for (const Tile& tile : wall.tiles) {
            EXPECT_NE(check.output.find(tile.name), std::string::npos) << tile.name << " missing:\n" << check.output;
        }
        const support::Ran ranks = support::runProgram("sandwall-check", file + " --ranks");
        EXPECT_EQ(ranks.output, std::to_string(wall.ranks()) + "\n");
        const support::Ran mono = support::runProgram("sandwall-check", file + " --mono");
        EXPECT_EQ(mono.status, 0) << mono.output;
    }
}

/// Locale that writes 1,5 for one and a half, and 1.024 for a thousand and twenty-four.
class DecimalComma : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(WallConfigs, MeanTheSameInALocaleWithDecimalCommas) {
    const Wall wall = config("tiled_3x4.toml");
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
    const Wall again = config("tiled_3x4.toml");
    std::locale::global(before);
    EXPECT_EQ(again, wall);
}

}  // namespace
}  // namespace walls
