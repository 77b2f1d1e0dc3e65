// SPDX-License-Identifier: Apache-2.0
// Each kind of odd raster in every reader of rasters. A scene reads sand and rock. sandwall-relax reads IN, IN of a
// mesh, and bedrock.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "scene/import/raster_file.hpp"
#include "tests/scene/import/classic_netcdf.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/support/files/text_forms.hpp"

namespace {

const std::string kHead = "ncols 3\nnrows 2\nxllcorner +500000\nyllcorner 5200000\ncellsize 10\n";
const std::string kSix = "1 2 3\n4 5 6\n";
const double kNone = std::nan("");

class EveryReader : public Import {
protected:
    /// Expects that every reader takes a raster for these heights [unit of lengths], row by row, north first.
    void expectHeights(const std::string& name, const std::string& file, const std::vector<double>& heights) {
        const scene::EsriGrid grid = scene::readRaster(path(file));
        ASSERT_EQ(grid.heights.size(), heights.size()) << name;
        // Sand and rock of the same heights: the scene would be refused if one of them were read in another way.
        const scene::Scene scene = load(terrainOf("dem", file) + "bedrock = \"" + file + "\"\n");
        ASSERT_EQ(scene.terrain.rows() * scene.terrain.columns(), static_cast<int>(heights.size())) << name;
        const support::Ran ran = relax(file + " --bedrock " + path(file), "out.tif");
        EXPECT_EQ(ran.status, 0) << name << ": " << ran.output;
        EXPECT_NE(ran.output.find("\"volume_before\":0,"), std::string::npos) << name << ": " << ran.output;
        const scene::EsriGrid out = scene::readRaster(path("out.tif"));
        for (int row = 0; row < grid.rows; ++row) {
            for (int column = 0; column < grid.columns; ++column) {
                const double expected = heights[grid.index(column, row)];
                if (std::isnan(expected)) {
                    EXPECT_TRUE(scene.ground->isWall(column, row)) << name;
                    EXPECT_TRUE(out.isNoData(column, row)) << name;
                    continue;
                }
                const double unit = scene.terrain.unit();
                EXPECT_NEAR(scene.terrain.height(column, row) * unit, expected, unit) << name;
                EXPECT_EQ(scene.ground->bedrock(column, row), scene.terrain.height(column, row)) << name;
                EXPECT_NEAR(out.at(column, row), expected, unit) << name;
            }
        }
        EXPECT_EQ(out.westEdge, grid.westEdge) << name;
        EXPECT_EQ(out.southEdge, grid.southEdge) << name;
        expectMesh(name, file, heights);
    }
    /// Expects that every reader refuses a raster in one line with these words. `rock` says whether rock is refused
    /// too.
    void expectRefused(const std::string& name, const std::string& file, const std::string& words, bool rock = true) {
        const std::string level =
            "[field]\ncolumns = 3\nrows = 2\n[terrain]\nkind = \"flat\"\nbedrock = \"" + file + "\"\n";
        write("level.asc", kHead + "9 9 9\n9 9 9\n");
        EXPECT_NE(refusal(terrainOf("dem", file)).find(words), std::string::npos)
            << name << ", sand of a scene: " << refusal(terrainOf("dem", file));
        expectLine(name + ", IN", relax(file, "out.tif"), words);
        expectLine(name + ", IN of a mesh", relax(file + " --max-error 1", "out.obj"), words);
        if (rock) {
            EXPECT_NE(refusal(level).find(words), std::string::npos) << name << ", rock of a scene: " << refusal(level);
            expectLine(name + ", bedrock", relax("level.asc --bedrock " + path(file), "out.tif"), words);
        }
    }
    [[nodiscard]] static std::string terrainOf(const std::string& kind, const std::string& file) {
        return "[terrain]\nkind = \"" + kind + "\"\nfile = \"" + file + "\"\n";
    }
    /// Changes a raster through GDAL.
    void change(const std::string& file, const std::function<void(GDALDatasetH)>& act) const {
        GDALDatasetH dataset = GDALOpen(path(file).c_str(), GA_Update);
        act(dataset);
        GDALClose(dataset);
    }

private:
    [[nodiscard]] support::Ran relax(const std::string& in, const std::string& out) const {
        std::filesystem::remove(path("out.tif"));
        std::filesystem::remove(path("out.obj"));
        return support::runProgram("sandwall-relax", path(in) + " " + path(out) + " --talus 89");
    }
    void expectLine(const std::string& name, const support::Ran& ran, const std::string& words) const {
        EXPECT_EQ(ran.status, 2) << name << ": " << ran.output;
        EXPECT_NE(ran.output.find(words), std::string::npos) << name << ": " << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << name << ": " << ran.output;
        EXPECT_FALSE(std::filesystem::exists(path("out.tif"))) << name;
        EXPECT_FALSE(std::filesystem::exists(path("out.obj"))) << name;
    }
    /// A mesh has the heights of the raster at its vertices, and heights between them at corners without data.
    void expectMesh(const std::string& name, const std::string& file, std::vector<double> heights) const {
        std::erase_if(heights, [](double height) { return std::isnan(height); });
        const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
        const support::Ran ran = relax(file + " --max-error 0.000001", "out.obj");
        EXPECT_EQ(ran.status, 0) << name << ": " << ran.output;
        std::ifstream mesh(path("out.obj"));
        double least = std::numeric_limits<double>::max(), most = std::numeric_limits<double>::lowest();
        int vertices = 0;
        for (std::string line; std::getline(mesh, line);) {
            std::istringstream words(line);
            std::string word;
            double x = 0, y = 0, z = 0;
            if (words >> word >> x >> y >> z && word == "v") {
                ++vertices;
                least = std::min(least, z);
                most = std::max(most, z);
            }
        }
        constexpr double kUnits = 1e-4;  // of the range of heights
        EXPECT_NEAR(least, *lowest, kUnits * (*highest - *lowest)) << name;
        EXPECT_NEAR(most, *highest, kUnits * (*highest - *lowest)) << name;
        EXPECT_GE(vertices, 3) << name;
    }
};

TEST_F(EveryReader, TakesEveryFormOfText) {
    for (const test::TextForm& form : test::formsOf(kHead + "+1.5 2 3\n4 -5 6\n")) {
        write("t.asc", form.bytes);
        expectHeights(std::string(form.name), "t.asc", {1.5, 2, 3, 4, -5, 6});
    }
    write("t.asc", "ncols 3\nnrows 2\nxllcorner 500000\nyllcenter 5200005\ncellsize 10\n" + kSix);
    expectHeights("corner and centre", "t.asc", {1, 2, 3, 4, 5, 6});
    EXPECT_EQ(scene::readRaster(path("t.asc")).southEdge, 5200000);
}

TEST_F(EveryReader, ComparesNoDataAsTheFileStoresIt) {
    write("t.asc", kHead + "NODATA_value -9999.9\n1 2 -9999.900391\n4 5 6\n");
    expectHeights("32-bit floats", "t.asc", {1, 2, kNone, 4, 5, 6});
    write("t.asc", kHead + "NODATA_value -nan\n-nan 2 3\n4 5 6\n");
    expectHeights("-nan", "t.asc", {kNone, 2, 3, 4, 5, 6});
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, -9999.9, 4, 5, 6}, .noData = -9999.9});
    expectHeights("32-bit floats of a GeoTIFF", "t.tif", {1, 2, kNone, 4, 5, 6});
    writeRaster(
        "t.tif",
        {.columns = 3, .rows = 2, .heights = {0, 10000, 10010, 10020, 10030, 10040}, .type = GDT_UInt16, .noData = 0});
    change("t.tif", [](GDALDatasetH dataset) {
        GDALSetRasterScale(GDALGetRasterBand(dataset, 1), 0.1);
        GDALSetRasterOffset(GDALGetRasterBand(dataset, 1), -1000);
    });
    expectHeights("scaled", "t.tif", {kNone, 0, 1, 2, 3, 4});
    write("t.asc", kHead + "-3.40282e+38 2 3\n4 5 6\n");
    expectRefused("the lowest float", "t.asc", "1 cell has the height -3.40282e+38, which means no data; declare it: ");
}

TEST_F(EveryReader, ConvertsUnitsOrRefusesThemByName) {
    constexpr double kFoot = 0.3048;  // [m]
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .unit = "ft"});
    expectHeights("feet up", "t.tif", {kFoot, 2 * kFoot, 3 * kFoot, 4 * kFoot, 5 * kFoot, 6 * kFoot});
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .unit = "unspecified"});
    expectHeights("an unspecified unit", "t.tif", {1, 2, 3, 4, 5, 6});
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .unit = "fathoms"});
    expectRefused("fathoms", "t.tif", "heights in 'fathoms' (band), which is not a known unit");
    write("t.asc", kHead + kSix);
    write("t.prj",
          "Projection    UTM\nZone          33\nDatum         WGS84\nUnits         METERS\nZunits        "
          "FEET\nParameters\n");
    expectHeights("Zunits", "t.asc", {kFoot, 2 * kFoot, 3 * kFoot, 4 * kFoot, 5 * kFoot, 6 * kFoot});
}

TEST_F(EveryReader, RefusesDegrees) {
    write("t.asc", kHead + "1 1 1\n1 1 1\n");
    write("t.prj",
          "\xEF\xBB\xBFGEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",ELLIPSOID[\"WGS "
          "84\",6378137,298.257223563]],"
          "CS[ellipsoidal,2],AXIS[\"latitude\",north],AXIS[\"longitude\",east],ANGLEUNIT[\"degree\",0.0174532925199433]"
          "]");
    expectRefused("WKT2 behind a byte order mark", "t.asc", "are degrees, but sand needs lengths");
    write("t.prj", "hello\n");
    expectRefused("a .prj file of words", "t.asc", "t.prj: its coordinate system cannot be read");
    std::filesystem::remove(path("t.prj"));
    write("t.asc",
          "ncols 3\nnrows 2\nxllcorner 254.439584\nyllcorner 40.090416\ncellsize 0.000833333333\n2500 2510 2520\n2507 "
          "2517 2527\n");
    // Rock is compared with its sand, which is refused.
    expectRefused("0 to 360 degrees", "t.asc", "its lengths seem to be degrees", false);
    test::ClassicNetcdf file({{"lat", 2}, {"lon", 3}});
    file.add({"lon", {"lon"}, {{"units", "degrees_east"}, {"standard_name", "longitude"}}, {4.8, 4.801, 4.802}});
    file.add({"lat", {"lat"}, {{"units", "degrees_north"}, {"standard_name", "latitude"}}, {52.3, 52.301}});
    file.add({"z", {"lat", "lon"}, {{"units", "m"}}, {1, 1, 1, 1, 1, 1}});
    write("t.nc", file.bytes());
    expectRefused("axes", "t.nc", ", but sand needs lengths");
}

/// Returns a NetCDF file of 3 x 2 heights 1 to 6 on axes in this unit. With `second`, it has two variables.
std::string netcdf(const std::string& unit, bool second = false) {
    test::ClassicNetcdf file({{"y", 2}, {"x", 3}});
    file.add({"x", {"x"}, {{"units", unit}, {"standard_name", "projection_x_coordinate"}}, {0.5, 1.5, 2.5}});
    file.add({"y", {"y"}, {{"units", unit}, {"standard_name", "projection_y_coordinate"}}, {1.5, 0.5}});
    file.add({"z", {"y", "x"}, {{"units", "m"}}, {1, 2, 3, 4, 5, 6}});
    if (second) {
        file.add({"error", {"y", "x"}, {}, {1, 1, 1, 1, 1, 1}});
    }
    return file.bytes();
}

TEST_F(EveryReader, ComparesClaimsWithContents) {
    write("t.hdr", "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 5200000\ncellsize 10\nbyteorder LSBFIRST\n");
    write("t.flt", std::string(12, '\0'));
    expectRefused("a cut .flt", "t.flt", "do not fit its 12 bytes; the file may be cut");
    write("t.nc", netcdf("m").substr(0, netcdf("m").size() - 8));
    expectRefused("a cut NetCDF file", "t.nc", "the file is cut");
    write("t.nc", netcdf("m", true));
    expectRefused("two variables", "t.nc", "holds 2 variables (z, error), but heights are only one; choose it: ");
    write("t.nc", netcdf("km"));
    expectHeights("kilometres", "t.nc", {0.001, 0.002, 0.003, 0.004, 0.005, 0.006});
    write("t.grd", "DSAA\n3 2\n500005 500025\n5200005 5200015\n1 6\n1,5 2 3\n4 5 6\n");
    expectRefused("decimal commas", "t.grd", "t.grd:6: '1,5' has a decimal comma; write a decimal point");
    writeRaster("t.tif", {.columns = 20000, .rows = 2, .heights = std::vector<double>(40000, 1)});
    expectRefused("a wide raster", "t.tif", "16384", false);
}

TEST_F(EveryReader, TakesGdalsOwnValues) {
    writeRaster("t.tif", {.columns = 3,
                          .rows = 2,
                          .heights = {kNegativeByte - 3, 2, 3, 4, 5, 6},
                          .type = GDT_Byte,
                          .options = {"PIXELTYPE=SIGNEDBYTE"}});
    expectHeights("signed bytes", "t.tif", {-3, 2, 3, 4, 5, 6});
    writeRaster("t.tif", {.columns = 3,
                          .rows = 2,
                          .heights = {1, 2, 3, 4, 5, 6},
                          .type = GDT_UInt16,
                          .options = {"PHOTOMETRIC=MINISWHITE"}});
    expectHeights("white is zero", "t.tif", {1, 2, 3, 4, 5, 6});
    writeRaster(
        "t.tif",
        {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .place = {{500000, 10, 1e-15, 5200000, 1e-15, -10}}});
    expectHeights("a turn of a rounding error", "t.tif", {1, 2, 3, 4, 5, 6});
}

}  // namespace
