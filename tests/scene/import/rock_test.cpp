// SPDX-License-Identifier: Apache-2.0
// Rock must have the units, the place and the coordinate system of the sand on it, in scenes and in sandwall-relax.
#include <fmt/format.h>

#include "tests/scene/import/units_fixture.hpp"

namespace {

class Rock : public Units {
protected:
    /// Returns how relaxing sand on rock ends. Both files have the same heights.
    [[nodiscard]] support::Ran relaxed() {
        return support::runProgram("sandwall-relax",
                                   path("t.asc") + " " + path("out.asc") + " --talus 1 --bedrock " + path("rock.asc"));
    }
};

// Sand that is as high as its rock cannot move. If only one of them were converted, it would be 2.28 thick or below it.
TEST_F(Rock, HasTheHeightsOfTheSameFile) {
    writeText();
    std::filesystem::copy_file(path("t.asc"), path("rock.asc"));
    write("t.prj", wktOf("EPSG:2263+5703", "WKT1_ESRI"));
    write("rock.prj", wktOf("EPSG:2263+5703", "WKT1_ESRI"));
    const support::Ran ran = relaxed();
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_NE(ran.output.find("\"volume_before\":0,"), std::string::npos) << ran.output;
    const scene::Scene scene = load("[terrain]\nkind = \"dem\"\nfile = \"t.asc\"\nbedrock = \"rock.asc\"\n");
    ASSERT_NE(scene.ground, nullptr);
    for (int column = 0; column < 3; ++column) {
        EXPECT_EQ(scene.ground->bedrock(column, 0), scene.terrain.height(column, 0));
    }
    ASSERT_EQ(scene.statements.value().size(), 2U);
    EXPECT_EQ((*scene.statements)[0].up, "metres");
    EXPECT_EQ((*scene.statements)[1].up, "metres");
    EXPECT_NE(ran.output.find("\"bedrock_units\":{\"across\":\"US survey feet\""), std::string::npos) << ran.output;
}

TEST_F(Rock, InOtherUnitsIsRefusedByName) {
    writeText();
    std::filesystem::copy_file(path("t.asc"), path("rock.asc"));
    const std::string scene = "[terrain]\nkind = \"dem\"\nfile = \"t.asc\"\nbedrock = \"rock.asc\"\n";
    write("t.prj", wktOf("EPSG:2263+5703", "WKT1_ESRI"));
    EXPECT_EQ(relaxed().status, 2);
    EXPECT_NE(refusal(scene).find("the rock declares no units, and the sand has US survey feet across and metres up"),
              std::string::npos)
        << refusal(scene);
    write("rock.prj", wktOf("EPSG:32633", "WKT1_ESRI"));
    EXPECT_NE(refusal(scene).find("the rock has metres across, and the sand US survey feet"), std::string::npos);
    EXPECT_EQ(relaxed().status, 2);
    std::filesystem::remove(path("t.prj"));
    write("rock.prj", wktOf("EPSG:2263+5703", "WKT1_ESRI"));
    EXPECT_NE(refusal(scene).find("the sand declares no units, and the rock has US survey feet across and metres up"),
              std::string::npos);
    EXPECT_EQ(relaxed().status, 2);
}

// Each line of the table is rock that does not fit sand of 3 x 2 cells of 10 from (500000, 5200000).
TEST_F(Rock, AtAnotherPlaceIsRefusedInOneLine) {
    writeText();
    const std::string scene = "[terrain]\nkind = \"{}\"\nfile = \"t.asc\"\nbedrock = \"rock.asc\"\n";
    const auto writeRock = [&](int columns, const char* west, const char* south, const char* cells) {
        const std::string row = columns == 3 ? "0 0 0\n" : "0 0\n";
        write("rock.asc", fmt::format("ncols {}\nnrows 2\nxllcorner {}\nyllcorner {}\n{}\n{}{}", columns, west, south,
                                      cells, row, row));
    };
    struct Odd {
        int columns;
        const char *west, *south, *cells, *found;
    };
    for (const Odd& odd :
         {Odd{3, "500010", "5200000", "cellsize 10", "3 x 2 cells of 10 x 10 from (500010, 5200000)"},
          Odd{3, "500000.02", "5200000", "cellsize 10", "3 x 2 cells of 10 x 10 from (500000.02, 5200000)"},
          Odd{3, "500000", "5200005", "cellsize 10", "3 x 2 cells of 10 x 10 from (500000, 5200005)"},
          Odd{3, "500000", "5200000.02", "cellsize 10", "3 x 2 cells of 10 x 10 from (500000, 5200000.02)"},
          Odd{3, "500000", "5200000", "cellsize 5", "3 x 2 cells of 5 x 5 from (500000, 5200000)"},
          Odd{3, "500000", "5200000", "cellsize 10.0001", "3 x 2 cells of 10.0001 x 10.0001 from (500000, 5200000)"},
          Odd{3, "500000", "5200000", "dx 10\ndy 10.0001", "3 x 2 cells of 10 x 10.0001 from (500000, 5200000)"},
          Odd{2, "500000", "5200000", "cellsize 10", "2 x 2 cells of 10 x 10 from (500000, 5200000)"}}) {
        writeRock(odd.columns, odd.west, odd.south, odd.cells);
        const std::string line = path("rock.asc") + ": " + odd.found + ", but " + path("t.asc") +
                                 ": 3 x 2 cells of 10 x 10 from (500000, 5200000): they must be the same; resample the "
                                 "rock: gdalwarp -te 500000 5200000 500030 5200020 -ts 3 2 -r bilinear";
        const support::Ran ran = relaxed();
        EXPECT_EQ(ran.status, 2);
        EXPECT_NE(ran.output.find(line), std::string::npos) << ran.output;
        for (const char* kind : {"dem", "esri_ascii"}) {
            const std::string refused = test::refusalOf([&] { (void)load(fmt::format(fmt::runtime(scene), kind)); });
            EXPECT_EQ(refused, line) << kind;
        }
    }
    // Less than a thousandth of a cell, or a millionth of its side, is a matter of printed digits.
    writeRock(3, "500000.009", "5200000.009", "cellsize 10.000009");
    EXPECT_EQ(relaxed().status, 0);
    EXPECT_NO_THROW((void)load(fmt::format(fmt::runtime(scene), "dem")));
}

// Zones have the same numbers for places that are 6 degrees apart.
TEST_F(Rock, InAnotherCoordinateSystemIsRefusedInOneLine) {
    writeText();
    write("rock.asc", "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 5200000\ncellsize 10\n0 0 0\n0 0 0\n");
    write("t.prj", wktOf("EPSG:32633", "WKT1_ESRI"));
    write("rock.prj", wktOf("EPSG:32632", "WKT1_GDAL"));
    const std::string line = path("rock.asc") + ": the rock's coordinate system is EPSG:32632, and that of the sand " +
                             path("t.asc") +
                             " is WGS 84 / UTM zone 33N; warp the rock to the sand's with gdalwarp -t_srs";
    const support::Ran ran = relaxed();
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.output.find(line), std::string::npos) << ran.output;
    const std::string scene = "[terrain]\nkind = \"dem\"\nfile = \"t.asc\"\nbedrock = \"rock.asc\"\n";
    EXPECT_EQ(test::refusalOf([&] { (void)load(scene); }), line);
}

TEST_F(Rock, FitsInEveryFormOfTheSameSystem) {
    writeText();
    write("rock.asc", "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 5200000\ncellsize 10\n0 0 0\n0 0 0\n");
    const std::string scene = "[terrain]\nkind = \"dem\"\nfile = \"t.asc\"\nbedrock = \"rock.asc\"\n";
    for (const char* system : {"EPSG:32633", "EPSG:25832", "EPSG:3035", "EPSG:31467", "EPSG:27700", "EPSG:2263"}) {
        for (const char* ofSand : {"WKT1_ESRI", "WKT1_GDAL", "WKT2_2018"}) {
            for (const char* ofRock : {"WKT1_ESRI", "WKT1_GDAL", "WKT2_2018"}) {
                write("t.prj", wktOf(system, ofSand));
                write("rock.prj", wktOf(system, ofRock));
                EXPECT_EQ(refusal(scene), "accepted") << system << ": " << ofSand << ", " << ofRock;
            }
        }
    }
    // Heights of both files become metres, whatever the unit of their vertical datum is.
    write("t.prj", wktOf("EPSG:32633+5703", "WKT1_ESRI"));
    for (const char* below : {"EPSG:32633", "EPSG:32633+6360"}) {
        write("rock.prj", wktOf(below, "WKT2_2018"));
        EXPECT_EQ(refusal(scene), "accepted") << below;
    }
    std::filesystem::remove(path("rock.prj"));
    EXPECT_EQ(refusal(scene), "accepted") << "rock that declares no system";
}

}  // namespace
