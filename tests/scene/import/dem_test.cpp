// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <limits>

#include "scene/model/scene.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/support/refusal.hpp"

namespace {

const std::string kDem = "[terrain]\nkind = \"dem\"\nfile = \"t.tif\"\n";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_F(Import, ADemBringsHeightsAndItsPlace) {
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}});
    const scene::Scene scene = load(kDem + "datum = 1\n");
    ASSERT_EQ(scene.terrain.columns(), 3);
    ASSERT_EQ(scene.terrain.rows(), 2);
    EXPECT_EQ(scene.terrain.cellSize(), 10);
    EXPECT_EQ(scene.terrain.height(0, 1), 0);
    EXPECT_EQ(scene.terrain.height(2, 0), sand::kUnitsPerCell / 2);
    EXPECT_EQ(scene.ground, nullptr);
    EXPECT_EQ(scene.georeference.west, 1000);
    EXPECT_EQ(scene.georeference.south, 1980);
    EXPECT_EQ(scene.georeference.datum, 1);
    EXPECT_EQ(scene.georeference.units.lengthMetres, 1);
    EXPECT_NE(scene.georeference.units.crs.find("UTM zone 33N"), std::string::npos);
}

TEST_F(Import, TheGeoreferenceTravelsWithTheSceneAndOlderScenesHaveNone) {
    writeRaster("t.tif", {.columns = 2, .rows = 2, .heights = {1, 2, 3, 4}});
    scene::Scene scene = load(kDem);
    scene.statements.reset();  // they would follow the georeference
    base::Bytes bytes = scene.encode();
    EXPECT_EQ(scene::Scene::decode(bytes).georeference, scene.georeference);
    scene::Scene nowhere = scene;
    nowhere.georeference = {};
    const base::Bytes older = nowhere.encode();
    ASSERT_LT(older.size(), bytes.size());
    EXPECT_TRUE(std::equal(older.begin(), older.end(), bytes.begin())) << "the bytes before it have not changed";
    EXPECT_EQ(scene::Scene::decode(older).georeference, scene::Georeference{});
    EXPECT_EQ(nowhere.rules.digest(), scene.rules.digest());
    bytes[older.size()] = 200;
    EXPECT_THROW((void)scene::Scene::decode(bytes), base::FormatError);
    bytes[older.size()] = 1;
    bytes.pop_back();
    EXPECT_THROW((void)scene::Scene::decode(bytes), base::FormatError);
}

TEST_F(Import, PixelsWithoutDataAreWalls) {
    writeRaster(
        "t.tif",
        {.columns = 4, .rows = 3, .heights = {-9999, 1, 1, 1, -9999, 2, -9999, 2, -9999, 3, 3, kNan}, .noData = -9999});
    const scene::Scene scene = load(kDem);
    ASSERT_EQ(scene.terrain.columns(), 3) << "the edge without data is cut off";
    EXPECT_EQ(scene.georeference.west, 1010);
    ASSERT_NE(scene.ground, nullptr);
    EXPECT_TRUE(scene.ground->isWall(1, 1));
    EXPECT_TRUE(scene.ground->isWall(2, 0)) << "NaN means no data";
    EXPECT_FALSE(scene.ground->isWall(0, 0));
}

TEST_F(Import, TransparentPixelsAreWalls) {
    writeRaster("t.tif", {.columns = 3,
                          .rows = 2,
                          .heights = {255, 7, 9, 255, 0, 8},
                          .type = GDT_Byte,
                          .bands = 2,
                          .options = {"ALPHA=YES"}});
    const scene::Scene scene = load(kDem);
    ASSERT_NE(scene.ground, nullptr) << "both bands hold the same; pixels are masked where the second is 0";
    EXPECT_TRUE(scene.ground->isWall(1, 0));
    EXPECT_FALSE(scene.ground->isWall(1, 1));
}

TEST_F(Import, PixelsThatArePointsLieHalfAPixelFurther) {
    const Raster area{.columns = 2, .rows = 2, .heights = {1, 2, 3, 4}, .pixelIs = "Area"};
    Raster point = area;
    point.pixelIs = "Point";
    writeRaster("t.tif", area);
    const scene::Scene areas = load(kDem);
    // GDAL returns corners to a program that writes. The file contains the middle, which is read as a corner again.
    writeRaster("t.tif", point);
    EXPECT_EQ(load(kDem).georeference, areas.georeference);
}

TEST_F(Import, RowsFromTheSouthAreTurnedOver) {
    writeRaster("t.tif", {.columns = 1, .rows = 3, .heights = {10, 20, 30}, .place = {{0, 10, 0, 500, 0, 10}}});
    const scene::Scene scene = load(kDem);
    EXPECT_EQ(scene.georeference.south, 500);
    EXPECT_EQ(scene.terrain.height(0, 0), sand::kUnitsPerCell);
    EXPECT_EQ(scene.terrain.height(0, 2), 3 * sand::kUnitsPerCell);
}

TEST_F(Import, HeightsInFeetOverMetresAreConverted) {
    writeRaster("t.tif", {.columns = 1, .rows = 2, .heights = {0, 1000}, .unit = "ft"});
    const scene::Scene scene = load(kDem);
    EXPECT_EQ(scene.terrain.height(0, 0), std::lround(304.8 / 10 * sand::kUnitsPerCell));
    EXPECT_NEAR(scene.georeference.cubicMetres(), 1, 1e-12);
    // EPSG 2227 counts lengths and heights in survey feet. Only cubic metres need a conversion.
    writeRaster("t.tif", {.columns = 1, .rows = 2, .heights = {0, 1000}, .epsg = 2227});
    const scene::Scene feet = load(kDem);
    EXPECT_EQ(feet.terrain.height(0, 0), 100 * sand::kUnitsPerCell);
    EXPECT_NEAR(feet.georeference.cubicMetres(), std::pow(1200.0 / 3937, 3), 1e-12);
}

TEST_F(Import, ScaledNumbersAreHeights) {
    writeRaster("t.tif", {.columns = 1, .rows = 2, .heights = {0, 1000}, .type = GDT_Int16});
    GDALDatasetH dataset = GDALOpen(path("t.tif").c_str(), GA_Update);
    GDALSetRasterScale(GDALGetRasterBand(dataset, 1), 0.1);
    GDALSetRasterOffset(GDALGetRasterBand(dataset, 1), 5);
    GDALClose(dataset);
    EXPECT_EQ(load(kDem).terrain.height(0, 1), sand::kUnitsPerCell / 2);
    EXPECT_EQ(load(kDem).terrain.height(0, 0), sand::kUnitsPerCell * 21 / 2);
}

TEST_F(Import, AnEsriGridHasTheSystemThatStandsBesideIt) {
    write("t.asc", "ncols 2\nnrows 1\nxllcorner 300\nyllcorner 400\ncellsize 2\n1.1 2\n");
    writePrj("t.prj", 32633);
    const scene::Scene scene = load("[terrain]\nkind = \"dem\"\nfile = \"t.asc\"\n");
    EXPECT_EQ(scene.georeference.west, 300);
    EXPECT_NE(scene.georeference.units.crs.find("zone"), std::string::npos) << scene.georeference.units.crs;
    EXPECT_EQ(scene.terrain.height(0, 0), std::lround(1.1 / 2 * sand::kUnitsPerCell)) << "as text holds it";
}

TEST_F(Import, DegreesAreRefusedWithTheCommandThatMakesMetres) {
    writeRaster(
        "t.tif",
        {.columns = 2, .rows = 2, .heights = {1, 2, 3, 4}, .place = {{-120.2, 0.1, 0, 37, 0, -0.1}}, .epsg = 4326});
    EXPECT_EQ(refusal(kDem),
              "t.tif: its coordinates (WGS 84) are degrees, but sand needs lengths; make metres of them: gdalwarp "
              "-t_srs EPSG:32610 -r bilinear t.tif metres.tif");
    // A tile of the shuttle mission: 1201 x 1201 big-endian numbers, with its place in its name.
    write("S23W043.hgt", std::string(2 * 1201 * 1201, '\1'));
    EXPECT_EQ(
        refusal("[terrain]\nkind = \"dem\"\nfile = \"S23W043.hgt\"\n"),
        "S23W043.hgt: its coordinates (WGS 84) are degrees, but sand needs lengths; make metres of them: gdalwarp "
        "-t_srs EPSG:32723 -r bilinear S23W043.hgt metres.tif");
}

TEST_F(Import, RastersThatAreNoFieldSayWhy) {
    const Raster good{.columns = 2, .rows = 2, .heights = {1, 2, 3, 4}};
    const auto refused = [&](const auto& change) {
        Raster raster = good;
        change(raster);
        writeRaster("t.tif", raster);
        return refusal(kDem);
    };
    EXPECT_EQ(refused([](Raster& r) {
                  r.place = {{0, 10, 1, 0, 1, -10}};
              }),
              "t.tif: is turned or mirrored; straighten it: gdalwarp -r bilinear t.tif straight.tif");
    EXPECT_EQ(
        refused([](Raster& r) {
            r.place = {{0, 10, 0, 0, 0, -20}};
        }),
        "s.toml:3: t.tif has cells of 10 x 20; a scene's are square; resample it: gdalwarp -tr 10 10 -r bilinear");
    EXPECT_EQ(refused([](Raster& r) { r.place.reset(); }),
              "t.tif: has no position and no pixel size; kind = \"image\" takes pictures");
    EXPECT_EQ(refused([](Raster& r) { r.bands = 3; }),
              "t.tif: has 3 bands, but heights are only one; choose it: gdal_translate -b NUMBER t.tif dem.tif");
    EXPECT_EQ(
        refused([](Raster& r) { r.unit = "fathom"; }),
        "t.tif: heights in 'fathom' (band), which is not a known unit; known are m, ft, us-ft, cm, mm and km; set it: "
        "gdal_edit.py -units m");
    EXPECT_EQ(refused([](Raster& r) { r.type = GDT_CFloat32; }), "t.tif: holds complex numbers instead of heights");
    EXPECT_EQ(
        refused([](Raster& r) { r.heights[2] = std::numeric_limits<double>::infinity(); }),
        "t.tif: the height of pixel 1, 2 (from the north-west) is infinite; mask it: gdal_translate -a_nodata inf");
    EXPECT_EQ(refused([](Raster& r) {
                  r.heights = {9, 9, 9, 9};
                  r.noData = 9;
              }),
              "t.tif: every cell is a no-data cell; there is no terrain in it");
    EXPECT_EQ(refused([](Raster& r) { r.heights[0] = 1e9; }),
              "s.toml:3: a height of 1000000000 is beyond the range of ±40960 (4096 cells); set 'datum'");
}

TEST_F(Import, BrokenRastersAreOneLineWithTheCause) {
    write("t.tif", "no raster at all");
    EXPECT_EQ(refusal(kDem).rfind("t.tif: cannot be read as a raster: ", 0), 0U) << refusal(kDem);
    EXPECT_EQ(refusal("[terrain]\nkind = \"dem\"\nfile = \"none.tif\"\n"), "none.tif: cannot be read; check the path");
    EXPECT_EQ(refusal("[terrain]\nkind = \"dem\"\nfile = \"/vsicurl/http://localhost/t.tif\"\n"),
              "/vsicurl/http://localhost/t.tif: cannot be read; check the path");
    EXPECT_EQ(refusal("[terrain]\nkind = \"dem\"\nfile = \"NETCDF:t.nc:z\"\n"),
              "NETCDF:t.nc:z: cannot be read; check the path");
    writeRaster("t.tif", {.columns = 64, .rows = 64, .heights = std::vector<double>(64 * 64, 1)});
    std::filesystem::resize_file(folder_ / "t.tif", std::filesystem::file_size(folder_ / "t.tif") / 2);
    const std::string line = refusal(kDem);
    EXPECT_EQ(line.rfind("t.tif: ", 0), 0U) << line;
    EXPECT_GT(line.size(), 20U) << line;
}

TEST_F(Import, FilesThatReferToOthersAreNotFollowed) {
    writeRaster("good.tif", {.columns = 1, .rows = 1, .heights = {1}});
    write("t.vrt",
          "<VRTDataset rasterXSize=\"1\" rasterYSize=\"1\"><GeoTransform>0,1,0,0,0,-1</GeoTransform>"
          "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"1\">good.tif"
          "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>");
    const std::string line = refusal("[terrain]\nkind = \"dem\"\nfile = \"t.vrt\"\n");
    EXPECT_EQ(line.rfind("t.vrt: cannot be read as a raster: ", 0), 0U) << line;
}

long residentKilobytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

// 8192 x 8192 pixels take 256 MiB as floats. The files are sparse.
TEST_F(Import, ARastersSizeIsLookedAtBeforeItsPixelsAreRead) {
    constexpr int kSide = 8192;
    Raster huge{.columns = kSide, .rows = kSide, .heights = {}, .type = GDT_Byte, .options = {"SPARSE_OK=TRUE"}};
    writeRaster("t.tif", huge);
    huge.type = GDT_Float32;
    writeRaster("f.tif", huge);
    std::string scan = "Gwyddion Simple Field 1.0\nXRes = 8192\nYRes = 8192\n";
    scan.append(4 - scan.size() % 4, '\0');
    write("t.gsf", scan);
    std::filesystem::resize_file(folder_ / "t.gsf", scan.size() + std::uintmax_t{4} * kSide * kSide);
    const long before = residentKilobytes();
    const auto refuse = [](const scene::RasterSize& size) {
        throw base::InputError(fmt::format("{} x {} are too many", size.columns, size.rows));
    };
    for (const std::string terrain :
         {"kind = \"dem\"\nfile = \"t.tif\"", "kind = \"dem\"\nfile = \"f.tif\"",
          "kind = \"image\"\nhigh = 1\nfile = \"t.tif\"", "kind = \"gsf\"\nfile = \"t.gsf\""}) {
        const std::string file = write("s.toml", text("[terrain]\n" + terrain + "\n"));
        EXPECT_EQ(test::refusalOf([&] { (void)scene::loadScene(file, {.raster = refuse}); }),
                  "8192 x 8192 are too many")
            << terrain;
    }
    bool asked = false;
    const std::string file = write("s.toml", text(kDem));
    EXPECT_THROW((void)scene::loadScene(file, {.field =
                                                   [&](const sand::FieldSize&) {
                                                       asked = true;
                                                       throw base::InputError("too many");
                                                   }}),
                 base::InputError);
    EXPECT_TRUE(asked) << "whole numbers without a mask: the field is as large as the raster";
    EXPECT_LT(residentKilobytes() - before, 100'000);
}

TEST_F(Import, HugeRastersAreRefusedBeforeTheyAreRead) {
    writeRaster("t.tif", {.columns = 40000, .rows = 20000, .heights = {}, .options = {"SPARSE_OK=TRUE"}});
    EXPECT_EQ(refusal(kDem),
              "t.tif: 40000 x 20000 pixels would take 3.2 GB, and 2.1 GB is the most; coarsen it: gdal_translate -r "
              "average -outsize 81% 0 t.tif coarser.tif");
    writeRaster("t.tif", {.columns = 16385, .rows = 1, .heights = {}, .options = {"SPARSE_OK=TRUE"}});
    EXPECT_EQ(refusal(kDem), "s.toml:3: t.tif has 16385 x 1 cells; a scene's are at most 16384 a side");
}

}  // namespace
