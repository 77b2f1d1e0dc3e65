// SPDX-License-Identifier: Apache-2.0
// Units of the lengths and heights of a raster, and where they come from.
#include <fmt/format.h>

#include "scene/import/importer.hpp"
#include "scene/import/prj_file.hpp"
#include "tests/scene/import/classic_netcdf.hpp"
#include "tests/scene/import/units_fixture.hpp"
#include "tests/support/files/text_forms.hpp"

namespace {

constexpr double kUsFoot = 1200.0 / 3937;  // [m]

TEST_F(Units, APrjFileIsReadInEveryFormAndEncoding) {
    writeText();
    for (const char* form : {"WKT1_ESRI", "WKT1_GDAL", "WKT2_2015", "WKT2_2018"}) {
        for (const test::TextForm& encoded : test::formsOf(wktOf("EPSG:32633", form) + "\n")) {
            write("t.prj", encoded.bytes);
            const std::string statement = statementOf("t.asc");
            EXPECT_TRUE(statement.starts_with("metres across (")) << form << ", " << encoded.name << ": " << statement;
        }
        write("t.prj", wktOf("EPSG:4326", form));
        EXPECT_TRUE(refusedRaster("t.asc").starts_with("t.asc: its coordinates (")) << form;
        EXPECT_NE(refusedRaster("t.asc").find("are degrees, but sand needs lengths"), std::string::npos) << form;
    }
    write("t.prj", "+proj=utm +zone=33 +datum=WGS84");
    EXPECT_TRUE(statementOf("t.asc").starts_with("metres across (")) << "PROJ's own form";
}

TEST_F(Units, APrjFileThatCannotBeReadIsAnError) {
    writeText();
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .epsg = 0});
    for (const char* text :
         {"", "\n", "hello\n", "PROJCS[", "GEOGCRS[\"x\"", "VERT_CS[\"Normal Null\",VERT_DATUM[\"NN\",2005]]"}) {
        write("t.prj", text);
        for (const char* file : {"t.asc", "t.tif"}) {
            const std::string refused = refusedRaster(file);
            EXPECT_TRUE(refused.starts_with("t.prj: its coordinate system cannot be read")) << text << ": " << refused;
        }
    }
}

TEST_F(Units, EveryReaderOfTextRefusesAPrjInDegrees) {
    writeText("xllcorner 4.8\nyllcorner 52.3");
    write("level.asc", "ncols 3\nnrows 2\nxllcorner 4.8\nyllcorner 52.3\ncellsize 10\n0 0 0\n0 0 0\n");
    for (const std::string& prj :
         {wktOf("EPSG:4326", "WKT1_ESRI"), wktOf("EPSG:4326", "WKT2_2018"),
          "\xEF\xBB\xBF" + wktOf("EPSG:4326", "WKT1_ESRI"),
          std::string("Projection    GEOGRAPHIC\nDatum         WGS84\nUnits         DD\nParameters\n")}) {
        write("t.prj", prj);
        write("level.prj", prj);
        for (const std::string kind : {"dem", "esri_ascii"}) {
            EXPECT_NE(refusal("[terrain]\nkind = \"" + kind + "\"\nfile = \"t.asc\"\n").find("are degrees"),
                      std::string::npos)
                << kind << prj;
        }
        const support::Ran ran =
            support::runProgram("sandwall-relax", path("t.asc") + " " + path("out.asc") + " --talus 30");
        EXPECT_EQ(ran.status, 2) << ran.output;
        EXPECT_NE(refusal("[field]\ncolumns = 3\nrows = 2\n[terrain]\nkind = \"flat\"\nbedrock = \"level.asc\"\n")
                      .find("are degrees"),
                  std::string::npos)
            << "rock, " << prj;
    }
}

// A vertical datum gives the unit of heights. 1 m is 3937 / 1200 US survey feet, which the lengths are in.
TEST_F(Units, AVerticalDatumInThePrjConvertsHeights) {
    writeText();
    write("t.prj", wktOf("EPSG:2263+5703", "WKT1_ESRI"));  // New York in US survey feet, NAVD88 in metres
    scene::EsriGrid grid = scene::readRaster(path("t.asc"));
    EXPECT_EQ(scene::statementOf(grid).up, "metres");
    EXPECT_EQ(scene::statementOf(grid).upFrom, "vertical datum");
    EXPECT_EQ(scene::statementOf(grid).across, "US survey feet");
    EXPECT_NEAR(grid.heights[0], 1 / kUsFoot, 1e-12);
    write("t.prj", wktOf("EPSG:32633+6360", "WKT1_ESRI"));  // UTM in metres, NAVD88 in US survey feet
    grid = scene::readRaster(path("t.asc"));
    EXPECT_EQ(scene::statementOf(grid).across, "metres");
    EXPECT_EQ(scene::statementOf(grid).up, "US survey feet");
    EXPECT_NEAR(grid.heights[5], 6 * kUsFoot, 1e-12);
}

TEST_F(Units, ArcInfosZunitsConvertHeights) {
    writeText();
    const auto heightsOf = [&](const std::string& zunits) {
        write("t.prj", "Projection    UTM\nZone          33\nDatum         WGS84\nUnits         METERS\n" + zunits +
                           "Parameters\n");
        return scene::readRaster(path("t.asc")).heights[0];
    };
    EXPECT_EQ(heightsOf(""), 1);
    EXPECT_EQ(heightsOf("Zunits        METERS\n"), 1);
    EXPECT_EQ(heightsOf("Zunits        NO\n"), 1);
    EXPECT_NEAR(heightsOf("Zunits        FEET\n"), 0.3048, 1e-15);
    write("t.prj",
          "Projection    UTM\nZone          33\nDatum         WGS84\nUnits         METERS\nZunits 100\nParameters\n");
    EXPECT_EQ(
        refusedRaster("t.asc"),
        "t.asc: heights in '100' (t.prj), which is not a known unit; known are m, ft, us-ft, cm, mm and km; set it: "
        "gdal_edit.py -units m");
}

TEST_F(Units, TwoUnitsOfHeightsAreRefusedByName) {
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .epsg = 0, .unit = "ft"});
    write("t.prj", wktOf("EPSG:32633+5703", "WKT1_ESRI"));
    EXPECT_TRUE(
        refusedRaster("t.tif").starts_with("t.tif: its heights are in 'ft' (band) or in 'metre' (vertical datum); "))
        << refusedRaster("t.tif");
}

TEST_F(Units, NamesThatStandForNoUnitAreNone) {
    for (const char* name : {"unspecified", "Unknown", "none", "n/a", " "}) {
        writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .unit = name});
        EXPECT_EQ(statementOf("t.tif"),
                  "metres across (EPSG:32633), the same up (no unit of heights), no cells without data")
            << name;
    }
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, -1, 4, 5, 6}, .noData = -1, .unit = "ft"});
    EXPECT_EQ(statementOf("t.tif"), "metres across (EPSG:32633), feet up (band), no data -1 in 16.7 % of cells");
}

TEST_F(Units, TextHeadersNameTheUnitThatGdalDoesNotKnow) {
    const auto idrisi = [&](const std::string& unit, const std::string& scale) {
        write("t.rst", std::string(24, '\0'));
        write(
            "t.rdc",
            "file format : IDRISI Raster A.1\ndata type   : real\nfile type   : binary\ncolumns     : 3\nrows        : "
            "2\n"
            "ref. system : plane\nref. units  : " +
                unit + "\nunit dist.  : " + scale +
                "\nmin. X      : 0\nmax. X      : 30\nmin. Y      : 0\nmax. Y      : 20\nvalue units : unspecified\n");
        const std::string refused = refusedRaster("t.rst");
        return refused == "nothing" ? statementOf("t.rst") : refused;
    };
    EXPECT_EQ(idrisi("m", "1.0"), "metres across (Plane), the same up (no unit of heights), no cells without data");
    EXPECT_EQ(idrisi("ft", "1.0"), "feet across (Plane), the same up (no unit of heights), no cells without data");
    EXPECT_NE(idrisi("deg", "1.0").find("but sand needs lengths"), std::string::npos);
    EXPECT_NE(idrisi("rods", "1.0").find("its lengths are in 'rods', which is not a known unit"), std::string::npos);
    EXPECT_NE(idrisi("m", "1000").find("t.rdc: its unit of lengths is 1000 times 'm'"), std::string::npos);
    write("t.dat", std::string(24, '\0'));
    write("t.hdr",
          "ENVI\nsamples = 3\nlines = 2\nbands = 1\ndata type = 4\nbyte order = 0\n"
          "map info = {Arbitrary, 1, 1, 9, 50, 0.001, 0.001, 0, units=Degrees}\n");
    EXPECT_NE(refusedRaster("t.dat").find("but sand needs lengths"), std::string::npos) << refusedRaster("t.dat");
}

/// Writes a NetCDF file of 4 x 3 heights 1 to 12 on axes in these units.
std::string netcdf(const std::string& x, const std::string& y, const std::string& z,
                   const std::string& name = "projection_") {
    test::ClassicNetcdf file({{"y", 3}, {"x", 4}});
    const auto axis = [&](const std::string& letter, const std::string& unit) {
        std::vector<std::pair<std::string, std::string>> attributes{{"standard_name", name + letter + "_coordinate"}};
        if (!unit.empty()) {
            attributes.emplace_back("units", unit);
        }
        return attributes;
    };
    file.add({"x", {"x"}, axis("x", x), {0.5, 1.5, 2.5, 3.5}});
    file.add({"y", {"y"}, axis("y", y), {0.5, 1.5, 2.5}});
    file.add({"z", {"y", "x"}, {{"units", z}}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}});
    return file.bytes();
}

TEST_F(Units, AxesOfNetcdfGiveTheUnitOfLengths) {
    write("t.nc", netcdf("km", "km", "m"));
    const scene::EsriGrid kilometres = scene::readRaster(path("t.nc"));
    EXPECT_EQ(scene::statementOf(kilometres).text().substr(0, 38), "kilometres across (axes), metres up (b");
    EXPECT_NEAR(kilometres.at(0, 0), 0.001, 1e-18) << "1 m in the unit of lengths";
    write("t.nc", netcdf("m", "m", "ft"));
    EXPECT_NEAR(scene::readRaster(path("t.nc")).at(3, 2), 12 * 0.3048, 1e-12);
    write("t.nc", netcdf("", "", "ft"));
    EXPECT_EQ(scene::readRaster(path("t.nc")).at(3, 2), 12) << "lengths without a unit have that of heights";
    write("t.nc", netcdf("km", "km", "unknown"));
    EXPECT_EQ(refusedRaster("t.nc"),
              "t.nc: its lengths are in units of 1000 m (axes), and it does not declare the unit of its heights, which "
              "could be the same or metres; set the unit: gdal_edit.py -units m (of a GeoTIFF, which gdal_translate "
              "makes)");
    write("t.nc", netcdf("km", "m", "m"));
    EXPECT_EQ(refusedRaster("t.nc"), "t.nc: its axis 'x' is in km, and 'y' in m; write both in metres");
    write("t.nc", netcdf("furlongs", "furlongs", "m"));
    EXPECT_TRUE(refusedRaster("t.nc").starts_with("t.nc: its axis 'x' is in 'furlongs', which is not a known unit"))
        << refusedRaster("t.nc");
}

TEST_F(Units, AxesOfNetcdfInDegreesAreRefused) {
    for (const char* unit : {"degrees_east", "degree", "degrees", "radian"}) {
        write("t.nc", netcdf(unit, unit, "m"));
        const std::string refused = refusedRaster("t.nc");
        EXPECT_TRUE(refused.starts_with("t.nc: its axis 'x' is in " + std::string(unit) + ", but sand needs lengths"))
            << refused;
        EXPECT_NE(refusal("[terrain]\nkind = \"dem\"\nfile = \"t.nc\"\n").find("but sand needs lengths"),
                  std::string::npos);
    }
}

TEST_F(Units, ASceneDecidesAboutDegreesAsRelaxDoes) {
    // Steps of 10 on cells of 1/1200: 12000 times steeper than 45 degrees.
    std::string rows;
    for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 6; ++column) {
            rows += fmt::format("{} ", 2500 + 10 * column + 7 * row);
        }
        rows += '\n';
    }
    for (const char* west : {"-105.56", "254.44"}) {
        write("t.asc",
              fmt::format("ncols 6\nnrows 6\nxllcorner {}\nyllcorner 40.09\ncellsize 0.000833333\n", west) + rows);
        for (const std::string kind : {"dem", "esri_ascii"}) {
            const std::string terrain = "[terrain]\nkind = \"" + kind + "\"\nfile = \"t.asc\"\n";
            const std::string refused = refusal(terrain);
            EXPECT_NE(refused.find("its lengths seem to be degrees"), std::string::npos) << refused;
            EXPECT_NE(refused.find("; or insist on lengths with lengths = true"), std::string::npos) << refused;
            EXPECT_NE(refusal(terrain + "lengths = true\n").find("set 'datum'"), std::string::npos)
                << "now they are lengths";
        }
    }
}

TEST_F(Units, ATinSaysThemToo) {
    writeText();
    write("t.prj", wktOf("EPSG:32633", "WKT1_ESRI"));
    write("p.csv", "0,0,1\n1000,0,2\n0,1000,3\n1000,1000,4\n");
    const support::Ran raster =
        support::runProgram("sandwall-relax", path("t.asc") + " " + path("out.ply") + " --talus 30 --max-error 1");
    EXPECT_NE(raster.output.find("t.asc: metres across ("), std::string::npos) << raster.output;
    EXPECT_NE(raster.output.find("\"units\":{\"across\":\"metres\""), std::string::npos);
    const support::Ran points =
        support::runProgram("sandwall-relax", path("p.csv") + " " + path("out.ply") + " --talus 30");
    EXPECT_NE(points.output.find("p.csv: units of unknown length across (points), the same up (points)"),
              std::string::npos)
        << points.output;
    const scene::Scene scene = load("[terrain]\nkind = \"points\"\nfile = \"p.csv\"\n[tin]\n");
    ASSERT_EQ(scene.statements.value().size(), 1U);
    EXPECT_EQ((*scene.statements)[0].acrossFrom, "points");
}

}  // namespace
