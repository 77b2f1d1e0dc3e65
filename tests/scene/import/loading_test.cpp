// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "scene/import/esri_file.hpp"
#include "scene/import/importer.hpp"
#include "tests/scene/import/import_fixture.hpp"

namespace {

TEST_F(Import, OnlyScenesThatNameASourceMapItsLibraries) {
    write("t.asc", "ncols 2\nnrows 1\ncellsize 1\n1 2\n");
    const auto mapped = [&](const std::string& terrain) {
        const support::Ran ran = support::runProgram("loading_probe", write("s.toml", text(terrain)).string());
        EXPECT_EQ(ran.status, 0) << ran.output;
        return ran.output;
    };
    const std::string none = "sandwall-import no\nlibgdal no\nlibmuparser no\nlibproj no\n";
    EXPECT_EQ(mapped("[field]\n[terrain]"), none);
    EXPECT_EQ(mapped("[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\""), none);
    EXPECT_EQ(mapped("[field]\ncolumns = 4\n[terrain]\nkind = \"function\"\nx = [0, 1]\ny = [0, 1]\nz = \"x\""),
              "sandwall-import mapped\nlibgdal mapped\nlibmuparser mapped\nlibproj mapped\n")
        << "without it this test could not fail";
}

TEST_F(Import, RelaxingTextMapsNoLibraryOfOtherFormats) {
    writeRaster("t.tif", {.columns = 2, .rows = 1, .heights = {1, 2}});
    write("t.asc", "ncols 2\nnrows 1\ncellsize 1\n1 2\n");
    const auto relax = [&](const std::string& in, const std::string& out) {
        const support::Ran ran = support::runCommand("LD_DEBUG=files " SANDWALL_BIN_DIR "/sandwall-relax " + path(in) +
                                                     " " + path(out) + " --talus 30");
        EXPECT_EQ(ran.status, 0) << ran.output;
        return ran.output.find("libgdal") != std::string::npos;
    };
    EXPECT_FALSE(relax("t.asc", "out.asc"));
    write("square.asc", "ncols 2\nnrows 2\ncellsize 1\n1 2\n3 4\n");
    EXPECT_FALSE(relax("square.asc", "out.ply --vertices 9"));
    EXPECT_TRUE(relax("t.tif", "out.tif")) << "so that this test can fail";
}

TEST_F(Import, TextInDegreesIsRelaxedIntoNothing) {
    write("t.asc", "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 47\ncellsize 0.1\n1 2\n3 4\n");
    writePrj("t.prj", 4326);
    for (const char* out : {"out.asc", "out.tif", "out.ply --max-error 0.1"}) {
        const support::Ran ran = support::runProgram("sandwall-relax", path("t.asc") + " " + path(out) + " --talus 30");
        EXPECT_EQ(ran.status, 2) << out;
        EXPECT_EQ(ran.output, "sandwall-relax: " + path("t.asc") +
                                  ": its coordinates (WGS 84) are degrees, but sand needs lengths; make metres of "
                                  "them: gdalwarp -t_srs EPSG:32632 -r bilinear t.asc metres.tif\n");
    }
}

TEST_F(Import, RelaxedTextHasItsSystemBesideItAgain) {
    const std::string text =
        "ncols 2\nnrows 2\nxllcorner 500000\nyllcorner 5200000\ncellsize 10\n0.1 0.2\n0.30000000000000004 1e-5\n";
    write("t.asc", text);
    for (const std::string prj : {"t.PRJ", "t.prj"}) {
        writePrj(prj, 32633);
        const support::Ran ran =
            support::runProgram("sandwall-relax", path("t.asc") + " " + path("out.asc") + " --talus 30");
        ASSERT_EQ(ran.status, 0) << ran.output;
        EXPECT_NE(scene::loadImporter("test").readUnits(path("out.asc")).units.crs.find("UTM zone 33N"),
                  std::string::npos);
        EXPECT_EQ(scene::readEsriGrid(path("out.asc")).heights, scene::readEsriGrid(path("t.asc")).heights);
        std::filesystem::remove(path(prj));
        std::filesystem::remove(path("out.prj"));
    }
    writePrj("t.prj", 32633);
    write("t.asc", text + "7\n");
    const support::Ran ran =
        support::runProgram("sandwall-relax", path("t.asc") + " " + path("out.asc") + " --talus 30");
    EXPECT_EQ(ran.output, "sandwall-relax: " + path("t.asc") + ":8: more values than ncols x nrows = 4\n")
        << "names the line, as it does without a .prj file";
}

TEST_F(Import, ARelaxedGeoTiffKeepsItsPlaceItsMaskAndWhatDidNotMove) {
    writeRaster("t.tif", {.columns = 3,
                          .rows = 3,
                          .heights = {0.1, 0.2, 0.3, 8, -9999, 0.4, 0.5, 0.6, 0.7},
                          .epsg = 32633,
                          .type = GDT_Float64,
                          .noData = -9999,
                          .unit = "m"});
    const support::Ran ran =
        support::runProgram("sandwall-relax", path("t.tif") + " " + path("out.tif") + " --talus 34");
    ASSERT_EQ(ran.status, 0) << ran.output;
    GDALDatasetH out = GDALOpen(path("out.tif").c_str(), GA_ReadOnly);
    ASSERT_NE(out, nullptr);
    std::array<double, 6> place{};
    GDALGetGeoTransform(out, place.data());
    EXPECT_EQ(place, (std::array<double, 6>{1000, 10, 0, 2000, 0, -10}));
    EXPECT_NE(std::string(GDALGetProjectionRef(out)).find("32633"), std::string::npos);
    GDALRasterBandH band = GDALGetRasterBand(out, 1);
    EXPECT_STREQ(GDALGetRasterUnitType(band), "m");
    int hasNoData = 0;
    EXPECT_TRUE(std::isnan(GDALGetRasterNoDataValue(band, &hasNoData)))
        << "docs/relax.md: NaN, whatever number the source has";
    EXPECT_NE(hasNoData, 0);
    std::array<double, 9> heights{};
    std::array<unsigned char, 9> known{};
    ASSERT_EQ(GDALRasterIO(band, GF_Read, 0, 0, 3, 3, heights.data(), 3, 3, GDT_Float64, 0, 0), CE_None);
    ASSERT_EQ(GDALRasterIO(GDALGetMaskBand(band), GF_Read, 0, 0, 3, 3, known.data(), 3, 3, GDT_Byte, 0, 0), CE_None);
    GDALClose(out);
    EXPECT_EQ(known, (std::array<unsigned char, 9>{255, 255, 255, 255, 0, 255, 255, 255, 255}));
    EXPECT_TRUE(std::isnan(heights[4]));
    EXPECT_LT(heights[3], 7.5);
    EXPECT_EQ(heights[8], 0.7) << "to the last digit";
    ASSERT_EQ(support::runProgram("sandwall-relax", path("t.tif") + " " + path("out.asc") + " --talus 34").status, 0);
    const scene::EsriGrid text = scene::readEsriGrid(path("out.asc"));
    EXPECT_EQ(text.noData, -9999) << "a text grid has the source's";
    EXPECT_TRUE(text.isNoData(1, 1));
    EXPECT_EQ(support::runProgram("sandwall-relax", path("out.tif") + " " + path("again.tif") + " --talus 34").status,
              0);
}

}  // namespace
