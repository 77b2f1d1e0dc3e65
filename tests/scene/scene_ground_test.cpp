// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sand/grid/erosion.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/files/scene_fixture.hpp"

namespace {

const std::string kGrid = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n";
const std::string kFromGrid = "[material]\n[tool]\nradius = 2\n[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n";

TEST_F(SceneFile, SandWithoutEndHasNoGround) {
    const scene::Scene scene = scene::loadScene(write("s.toml", kFlat));
    EXPECT_EQ(scene.ground, nullptr);
    EXPECT_EQ(scene.rules.ground, 0U);
}

TEST_F(SceneFile, ALayerLiesOnRock) {
    write("t.asc", kGrid + "1 2 3\n4 5 6\n");
    const scene::Scene scene = scene::loadScene(write("s.toml", kFromGrid + "layer = 0.5\n"));
    ASSERT_NE(scene.ground, nullptr);
    EXPECT_EQ(scene.ground->sand(2, 0, scene.terrain.height(2, 0)), sand::kUnitsPerCell / 2);
}

TEST_F(SceneFile, CellsWithoutDataAreWallsAndEmptyEdgesAreCutOff) {
    write("t.asc", "ncols 4\nnrows 4\ncellsize 1\nNODATA_value -1\n-1 -1 -1 -1\n1 2 3 -1\n4 -1 6 -1\n7 8 9 -1\n");
    const scene::Scene scene = scene::loadScene(write("s.toml", kFromGrid));
    ASSERT_EQ(scene.terrain.columns(), 3);
    ASSERT_EQ(scene.terrain.rows(), 3);
    ASSERT_NE(scene.ground, nullptr);
    EXPECT_TRUE(scene.ground->isWall(1, 1));
    EXPECT_FALSE(scene.ground->isWall(2, 1));
    EXPECT_EQ(scene.terrain.height(0, 0), 7 * sand::kUnitsPerCell);
    EXPECT_EQ(scene.terrain.height(1, 1), sand::kUnitsPerCell) << "a wall is as high as the lowest sand";
}

TEST_F(SceneFile, RockComesFromASecondGrid) {
    write("t.asc", kGrid + "1 2 3\n4 5 6\n");
    write("rock.asc", kGrid + "0 0 0\n4 4 4\n");
    const scene::Scene scene = scene::loadScene(write("s.toml", kFromGrid + "bedrock = \"rock.asc\"\n"));
    ASSERT_NE(scene.ground, nullptr);
    EXPECT_EQ(scene.ground->bedrock(2, 0), 4 * sand::kUnitsPerCell);
    EXPECT_EQ(scene.ground->sand(0, 0, scene.terrain.height(0, 0)), 0);
    EXPECT_EQ(scene.ground->bedrock(1, 1), 0);
}

TEST_F(SceneFile, BadRockIsNamed) {
    write("t.asc", kGrid + "1 2 3\n4 5 6\n");
    write("above.asc", kGrid + "0 0 0\n4 5.5 4\n");
    write("small.asc", "ncols 1\nnrows 1\ncellsize 1\n0\n");
    EXPECT_EQ(complaint(kFromGrid + "bedrock = \"above.asc\"\n"),
              "s.toml:7: the layer of sand is -0.5 thick in column 2, row 1 (from the south-west); rock must lie at or "
              "below the sand");
    EXPECT_EQ(complaint(kFromGrid + "bedrock = \"small.asc\"\n"),
              "small.asc: 1 x 1 cells of 1 x 1 from (0, 0), but " + (folder_ / "t.asc").string() +
                  ": 3 x 2 cells of 1 x 1 from (0, 0): they must be the same; resample the rock: gdalwarp -te 0 0 3 2 "
                  "-ts 3 2 -r bilinear");
    EXPECT_EQ(
        complaint("[field]\ncolumns = 3\nrows = 2\n[material]\n[terrain]\nkind = \"flat\"\nbedrock = \"small.asc\"\n"),
        "s.toml:7: the rock has 1 x 1 cells, the terrain 3 x 2: they must be the same");
    EXPECT_EQ(complaint(kFromGrid + "layer = -1\n"), "s.toml:7: layer must be within [0, 1000000000], got -1");
    EXPECT_EQ(complaint(kFromGrid + "layer = 1\nbedrock = \"above.asc\"\n"),
              "s.toml:8: give 'layer' or 'bedrock', not both: each gives the height of the rock");
}

TEST_F(SceneFile, SettlesBeforeAnybodyTouchesIt) {
    const std::string steep =
        "[field]\ncolumns = 64\nwidth = 64\n[material]\n[tool]\nradius = 2\n[terrain]\nkind = "
        "\"dunes\"\ndune_height = 30\ndune_length = 20\n";
    const scene::Scene raw = scene::loadScene(write("s.toml", steep));
    const scene::Scene settled = scene::loadScene(write("s.toml", steep + "settle = true\n"));
    sand::HeightField field = settled.terrain;
    sand::grid::Erosion erosion(field, settled.rules);
    erosion.sweep(field, 1);
    EXPECT_TRUE(erosion.settled());
    EXPECT_FALSE(sameHeights(raw.terrain, settled.terrain));
    EXPECT_EQ(raw.terrain.volume(), settled.terrain.volume());
}

TEST_F(SceneFile, WetSandIsSteeperAndItsBanksStand) {
    const auto rulesOf = [&](const std::string& material) {
        return scene::loadScene(
                   write("s.toml", kFlat + "band = 0\nwet_talus_deg = 44\ncohesion_length = 0.1\n" + material))
            .rules;
    };
    const auto units = [](double degrees) { return std::lround(std::tan(degrees * std::numbers::pi / 180) * 65536); };
    EXPECT_EQ(rulesOf("").tuning.threshold, units(34));
    EXPECT_EQ(rulesOf("").tuning.startThreshold, units(34)) << "dry sand has no cohesion";
    EXPECT_EQ(rulesOf("humidity = 0.5\n").tuning.threshold, units(39));
    EXPECT_EQ(rulesOf("humidity = 1\n").tuning.threshold, units(44));
    EXPECT_EQ(rulesOf("humidity = 1\n").tuning.startThreshold, 1677721) << "0.1 of cells of 2 / 512, rounded down";
    EXPECT_EQ(complaint(kFlat + "wet_talus_deg = 20\n"),
              "s.toml:4: wet_talus_deg must be at least talus_deg = 34, got 20");
    EXPECT_EQ(complaint(kFlat + "humidity = 2\n"), "s.toml:4: humidity must be within [0, 1], got 2");
}

}  // namespace
