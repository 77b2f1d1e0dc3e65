// SPDX-License-Identifier: Apache-2.0
// Words, NaN, infinity and no data in every kind of terrain: the table of docs/terrain.md.
#include "scene/import/no_data.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "scene/model/scene.hpp"
#include "tests/scene/import/import_fixture.hpp"

namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

class NoData : public Import {
protected:
    /// Returns the refusal of a grid of 3 x 2 cells as a terrain of this kind, or "accepted".
    std::string refusedAs(const std::string& kind, const std::string& numbers, const std::string& more = "",
                          const std::string& name = "t.asc") {
        write(name, "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + more + numbers);
        return refusal(terrainOf(kind, name));
    }
    static std::string terrainOf(const std::string& kind, const std::string& file) {
        return "[terrain]\nkind = \"" + kind + "\"\nfile = \"" + file + "\"\n";
    }
    /// Returns the warnings of a scene without those about its tool, and without the folder.
    std::vector<std::string> warningsOf(const std::string& terrain) {
        std::vector<std::string> warnings = load(terrain).warnings;
        std::erase_if(warnings, [](const std::string& line) { return line.starts_with("a tool of radius "); });
        for (std::string& line : warnings) {
            const std::size_t at = line.find(folder_.string() + "/");
            line.erase(at == std::string::npos ? 0 : at, at == std::string::npos ? 0 : folder_.string().size() + 1);
        }
        return warnings;
    }
    using Lines = std::vector<std::string>;
};

// GDAL reads "abc" and "inf" as 0. The scene would then begin with a pit.
TEST_F(NoData, EitherKindRefusesAnEsriGridWithTheSameLine) {
    for (const std::string kind : {"esri_ascii", "dem"}) {
        for (const std::string word : {"abc", "nan", "inf", "1,5", "1e999"}) {
            EXPECT_EQ(refusedAs(kind, "1 2 3\n4 " + word + " 6\n"),
                      "t.asc:7: a height must be a finite number, got '" + word + "'" +
                          (word == "1,5" ? "; write a decimal point" : ""))
                << kind;
        }
        EXPECT_EQ(refusedAs(kind, "1 2 3\n4 abc 6\n", "NODATA_value -1\n"),
                  "t.asc:8: a height must be a finite number, got 'abc'")
            << kind;
        EXPECT_EQ(refusedAs(kind, "1 2 3\n4 nan 6\n", "NODATA_value nan\n"), "accepted") << kind;
        EXPECT_TRUE(load(terrainOf(kind, "t.asc")).ground->isWall(1, 0)) << kind;
    }
    EXPECT_EQ(refusedAs("dem", "1 2 3\n4 abc 6\n", "", "t.dat"), "t.dat:7: a height must be a finite number, got 'abc'")
        << "the file's name does not matter";
}

TEST_F(NoData, TextsInWhichAWordWouldBeZeroAreNotOpened) {
    write("t.grass", "north: 2\nsouth: 0\neast: 3\nwest: 0\nrows: 2\ncols: 3\n1 2 3\n4 abc 6\n");
    write("t.xyz", "x,y,z\n0.5,1.5,1\n1.5,1.5,2\n0.5,0.5,abc\n1.5,0.5,4\n");
    write("t.gxf", "#POINTS\n3\n#ROWS\n2\n#PTSEPARATION\n1\n#RWSEPARATION\n1\n#GRID\n1 2 3\n4 abc 6\n");
    write("t.zmap",
          "!\n@t, GRID, 4\n20, 1.0E+30,  , 7, 1\n2, 2, 0.0, 1.0, 0.0, 1.0\n0.0, 0.0, 0.0\n@\n"
          "                   1                 abc\n                   3                   4\n");
    for (const std::string name : {"t.grass", "t.xyz", "t.gxf", "t.zmap"}) {
        const std::string line = refusal(terrainOf("dem", name));
        EXPECT_TRUE(line.starts_with(name + ": cannot be read as a raster: ")) << line;
    }
}

TEST_F(NoData, ThatIsNotDeclaredIsAHeightWithAWarning) {
    write("t.asc", "ncols 3\nnrows 2\ncellsize 10\n1 -9999 3\n-9999 5 6\n");
    EXPECT_EQ(warningsOf(terrainOf("esri_ascii", "t.asc")),
              Lines{"t.asc: 2 cells have the height -9999, which usually means no data and is taken for a height here; "
                    "if it does, add the line 'NODATA_value -9999' to the header"});
    EXPECT_EQ(warningsOf(terrainOf("dem", "t.asc")), warningsOf(terrainOf("esri_ascii", "t.asc")));
    const Raster raster{.columns = 3, .rows = 1, .heights = {-32768, 2, 3}, .type = GDT_Int16};
    writeRaster("t.tif", raster);
    EXPECT_EQ(
        warningsOf(terrainOf("dem", "t.tif")),
        Lines{"t.tif: 1 cell has the height -32768, which usually means no data and is taken for a height here; if "
              "it does: gdal_edit.py -a_nodata -32768 t.tif"});
    write("p.csv", "0,0,1\n1000,0,2\n0,1000,-9999\n1000,1000,4\n");
    EXPECT_EQ(warningsOf(terrainOf("points", "p.csv") + "[tin]\ncell = 10\n"),
              Lines{"p.csv: 1 point has the height -9999, which usually means no data and is taken for a height here; "
                    "leave such lines out if it does"});
}

TEST_F(NoData, UsuallyHasOneOfThreeNegativeNumbers) {
    for (const double number : {-9999.0, -32768.0, -99999.0}) {
        EXPECT_TRUE(scene::isUsualNoData(number)) << number;
        // A height in feet is divided by its unit, and multiplied again.
        EXPECT_TRUE(scene::isUsualNoData(number * 0.3048 / 0.3048)) << number;
        EXPECT_FALSE(scene::isUsualNoData(-number)) << "a height of " << -number << " m can be real";
        EXPECT_FALSE(scene::isUsualNoData(number + 0.01)) << number;
        EXPECT_FALSE(scene::isUsualNoData(number - 0.01)) << number;
        write("t.asc", fmt::format("ncols 3\nnrows 2\ncellsize 100\n1 {} 3\n4 5 6\n", number));
        EXPECT_EQ(warningsOf(terrainOf("esri_ascii", "t.asc")),
                  Lines{fmt::format("t.asc: 1 cell has the height {0}, which usually means no data and is taken for a "
                                    "height here; if it does, add the line 'NODATA_value {0}' to the header",
                                    number)});
        write("t.asc", fmt::format("ncols 3\nnrows 2\ncellsize 100\n1 {} 3\n4 5 6\n", -number));
        EXPECT_EQ(warningsOf(terrainOf("esri_ascii", "t.asc")), Lines{});
    }
    for (const double number : {0.0, -999.0, -9998.0, -32767.0}) {
        EXPECT_FALSE(scene::isUsualNoData(number)) << number;
    }
}

TEST_F(NoData, ThatIsDeclaredWarnsOfNothing) {
    write("t.asc", "ncols 3\nnrows 2\ncellsize 10\nNODATA_value -9999\n1 -9999 3\n-9999 5 6\n");
    EXPECT_EQ(warningsOf(terrainOf("esri_ascii", "t.asc")), Lines{});
    EXPECT_EQ(warningsOf(terrainOf("dem", "t.asc")), Lines{});
    writeRaster("t.tif", {.columns = 3, .rows = 1, .heights = {-9999, 2, 3}, .noData = -9999});
    EXPECT_EQ(warningsOf(terrainOf("dem", "t.tif")), Lines{});
}

TEST_F(NoData, IsFoundInTheFilesUnitOfHeights) {
    writeRaster("t.tif", {.columns = 3, .rows = 1, .heights = {-9999, 2, 3}, .unit = "ft"});
    const Lines warnings = warningsOf(terrainOf("dem", "t.tif"));
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("1 cell has the height -9999,"), std::string::npos) << warnings[0];
}

TEST_F(NoData, ThatDoesNotFitTheRangeIsNamedInTheRefusal) {
    write("t.asc", "ncols 3\nnrows 2\ncellsize 1\n1 -9999 3\n4 5 6\n");
    EXPECT_EQ(refusal(terrainOf("esri_ascii", "t.asc")),
              "s.toml:3: a height of -9999 is beyond the range of ±4096 (4096 cells); declare it as no data, or set "
              "'datum'");
}

TEST_F(NoData, OfAScanIsNotANumber) {
    std::string scan = "Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 2\n";
    scan.append(4 - scan.size() % 4, '\0');
    for (const float height : {0.F, 0.5F, kNotANumber, 1.F}) {
        scan.append(reinterpret_cast<const char*>(&height), sizeof height);
    }
    write("t.gsf", scan);
    const scene::Scene scene = load(terrainOf("gsf", "t.gsf"));
    ASSERT_NE(scene.ground, nullptr);
    EXPECT_TRUE(scene.ground->isWall(0, 0));
    EXPECT_EQ(warningsOf(terrainOf("gsf", "t.gsf")), Lines{});
}

// GDAL writes and reads this place for programs that know no place.
TEST_F(NoData, ARasterWithoutGeoreferencingIsWarnedOf) {
    const std::string warning =
        "t.tif: has no coordinate system, and cells of 1 x 1 at (0, 0), as if it had no georeferencing; slopes are "
        "wrong if its cells have another size: gdal_edit.py -a_ullr WEST NORTH EAST SOUTH t.tif";
    Raster raster{.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .epsg = 0};
    using Transform = std::array<double, 6>;
    for (const Transform& place :
         {Transform{0, 1, 0, 0, 0, 1}, Transform{0, 1, 0, 0, 0, -1}, Transform{0, 1, 0, 2, 0, -1}}) {
        raster.place = place;
        writeRaster("t.tif", raster);
        EXPECT_EQ(warningsOf(terrainOf("dem", "t.tif")), Lines{warning}) << place[3] << ' ' << place[5];
    }
    const support::Ran ran =
        support::runProgram("sandwall-relax", path("t.tif") + " " + path("out.tif") + " --talus 34");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_NE(ran.output.find("sandwall-relax: warning: " + path("t.tif") + ": has no coordinate system"),
              std::string::npos)
        << ran.output;
    for (const Transform& place : {Transform{0, 2, 0, 0, 0, -2}, Transform{7, 1, 0, 0, 0, -1}}) {
        raster.place = place;
        writeRaster("t.tif", raster);
        EXPECT_EQ(warningsOf(terrainOf("dem", "t.tif")), Lines{}) << "a place that a user has chosen";
    }
    raster.place = Transform{0, 1, 0, 2, 0, -1};
    raster.epsg = 32633;
    writeRaster("t.tif", raster);
    EXPECT_EQ(warningsOf(terrainOf("dem", "t.tif")), Lines{}) << "a coordinate system";
}

TEST_F(NoData, RelaxingWarnsOfItToo) {
    write("t.asc", "ncols 3\nnrows 2\ncellsize 10\n1 -9999 3\n4 5 6\n");
    write("p.csv", "0,0,1\n1000,0,2\n0,1000,-9999\n1000,1000,4\n");
    for (const std::string& arguments : {path("t.asc") + " " + path("out.asc"), path("p.csv") + " " + path("out.ply"),
                                         path("t.asc") + " " + path("out.obj") + " --max-error 1"}) {
        const support::Ran ran = support::runProgram("sandwall-relax", arguments + " --talus 34");
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_NE(ran.output.find("\nsandwall-relax: warning: "), std::string::npos) << ran.output;
        EXPECT_NE(ran.output.find("the height -9999, which usually means no data"), std::string::npos) << ran.output;
    }
}

}  // namespace
