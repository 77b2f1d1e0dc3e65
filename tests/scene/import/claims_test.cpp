// SPDX-License-Identifier: Apache-2.0
// Compares the claims of a raster's header with the contents of its files.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>

#include "scene/import/esri_file.hpp"
#include "scene/import/importer.hpp"
#include "scene/import/raster_file.hpp"
#include "tests/scene/import/classic_netcdf.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/scene/import/raster_forms.hpp"
#include "tests/support/refusal.hpp"

namespace {

class Claims : public Import {
protected:
    [[nodiscard]] std::string refusedRaster(const std::string& file) const {
        std::string line = test::refusalOf([&] { (void)scene::readRaster(path(file)); });
        for (std::size_t at = 0; (at = line.find(folder_.string() + "/")) != std::string::npos;) {
            line.erase(at, folder_.string().size() + 1);
        }
        return line;
    }
    void cut(const std::string& name, std::uintmax_t bytes) const { std::filesystem::resize_file(path(name), bytes); }
    /// Writes numbers as they are in memory.
    template <class Number>
    void writeNumbers(const std::string& name, const std::vector<Number>& numbers) const {
        std::ofstream(path(name), std::ios::binary)
            .write(reinterpret_cast<const char*>(numbers.data()),
                   static_cast<std::streamsize>(numbers.size() * sizeof(Number)));
    }
};

const std::string kGridHeader =
    "ncols 4\nnrows 4\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nbyteorder LSBFIRST\n";

TEST_F(Claims, AFloatGridThatIsCutIsNotReadAsShorterNumbers) {
    std::vector<float> heights;
    for (int i = 1; i <= 16; ++i) {
        heights.push_back(static_cast<float>(i));
    }
    write("t.hdr", kGridHeader);
    writeNumbers("t.flt", heights);
    EXPECT_EQ(scene::readRaster(path("t.flt")).at(0, 3), 1);
    for (const std::uintmax_t bytes : {60U, 48U, 32U, 16U}) {
        cut("t.flt", bytes);
        const std::string refused = refusedRaster("t.flt");
        EXPECT_NE(refused, "nothing") << bytes;
        EXPECT_TRUE(refused.starts_with("t.flt: ")) << refused;
    }
    EXPECT_EQ(refusedRaster("t.flt").substr(0, 80),
              "t.flt: 4 x 4 cells of 32 bits, which is usual for .flt, do not fit its 16 bytes;");
}

TEST_F(Claims, ABilWithoutNbitsIsNotGuessed) {
    writeNumbers("t.bil", std::vector<std::int16_t>(16, 300));
    const std::string ulx = "nrows 4\nncols 4\nulxmap 500005\nulymap 5000035\nxdim 10\nydim 10\nbyteorder I\n";
    write("t.hdr", ulx);
    EXPECT_EQ(
        refusedRaster("t.bil"),
        "t.bil: 4 x 4 cells of 8 bits, which is usual for .bil, do not fit its 32 bytes; the file may be cut, or its "
        "header needs a line such as NBITS 16");
    write("t.hdr", ulx + "nbits 16\npixeltype SIGNEDINT\n");
    EXPECT_EQ(scene::readRaster(path("t.bil")).at(0, 0), 300);
    write("t.hdr", ulx + "nbits 8\n");
    EXPECT_EQ(
        refusedRaster("t.bil"),
        "t.bil: it has 2 times the bytes that its header says (16); correct the type of numbers, the columns or the "
        "rows in the header");
    write("t.hdr", ulx + "nbits 32\n");
    EXPECT_EQ(refusedRaster("t.bil"),
              "t.bil: its header says that it has 64 bytes, but it has 32; the file is cut; copy it again");
}

TEST_F(Claims, ARasterWithoutItsHeaderSaysWhatIsMissing) {
    for (const char* ending : {".flt", ".bil"}) {
        // GDAL's words stand between ours, and differ from version to version.
        const std::string name = std::string("t") + ending;
        const auto expectRefused = [&](const std::string& end) {
            const std::string line = refusedRaster(name);
            EXPECT_TRUE(line.starts_with(name + ": cannot be read as a raster: not recognized as ")) << line;
            EXPECT_TRUE(line.ends_with("supported file format; " + end)) << line;
        };
        write(name, std::string(24, '\0'));
        std::filesystem::remove(path("t.hdr"));
        expectRefused("it needs its header t.hdr beside it");
        write("t.hdr", "ncols 3\nxllcorner 0\nyllcorner 0\ncellsize 10\nbyteorder LSBFIRST\n");
        expectRefused("its header t.hdr has no nrows");
        write("t.hdr", "nrows 2\ncellsize 10\n");
        expectRefused("its header t.hdr has no ncols");
    }
    write("t.tif", std::string("II*\0\0", 5));
    EXPECT_EQ(refusedRaster("t.tif"), "t.tif: cannot be read as a raster: Cannot read TIFF header");
}

TEST_F(Claims, AnEnviRasterThatIsCutHasNoHeightsOfZero) {
    const std::string header =
        "ENVI\nsamples = 4\nlines = 4\nbands = 1\nheader offset = {}\nfile type = ENVI Standard\ndata type = 4\n"
        "interleave = bsq\nbyte order = 0\nmap info = {{UTM, 1, 1, 500000, 5000040, 10, 10, 33, North, WGS-84}}\n";
    write("t.hdr", fmt::format(fmt::runtime(header), 8));
    writeNumbers("t.dat", std::vector<float>(18, 7));
    EXPECT_EQ(scene::readRaster(path("t.dat")).at(0, 0), 7);
    cut("t.dat", 71);
    EXPECT_EQ(refusedRaster("t.dat"),
              "t.dat: its header says that it has 72 bytes, but it has 71; the file is cut; copy it again");
    write("t.hdr", fmt::format(fmt::runtime(header), 0));
    cut("t.dat", 64);
    EXPECT_EQ(scene::readRaster(path("t.dat")).at(0, 0), 7);
    cut("t.dat", 40);
    EXPECT_NE(refusedRaster("t.dat").find("64 bytes, but it has 40"), std::string::npos);
}

TEST_F(Claims, ANetcdfFileThatIsCutHasNoHeightsOfZero) {
    test::ClassicNetcdf file({{"y", 3}, {"x", 3}});
    file.add({"x", {"x"}, {{"units", "m"}, {"standard_name", "projection_x_coordinate"}}, {5, 15, 25}});
    file.add({"y", {"y"}, {{"units", "m"}, {"standard_name", "projection_y_coordinate"}}, {5, 15, 25}});
    file.add({"z", {"y", "x"}, {{"units", "m"}}, {1, 2, 3, 4, 5, 6, 7, 8, 9}});
    const std::string bytes = file.bytes();
    write("t.nc", bytes);
    EXPECT_EQ(scene::readRaster(path("t.nc")).at(2, 2), 9);
    write("t.nc", bytes.substr(0, bytes.size() - 1));
    EXPECT_EQ(refusedRaster("t.nc"),
              fmt::format("t.nc: its header says that it has {} bytes, but it has {}; the file is cut; "
                          "copy it again",
                          bytes.size(), bytes.size() - 1));
}

/// Formats whose numbers take all the file, so that a cut file has fewer of them. Drivers that compress, or that have
/// their numbers elsewhere, are cut in other tests.
TEST_F(Claims, NoFormatIsReadWhenItIsCut) {
    std::set<std::string> tried;
    int number = 0;
    for (const test::RasterForm& form : test::rasterForms()) {
        const bool plain = form.noData == test::RasterForm::NoData::none && !form.scaled && !form.southFirst;
        if (!plain || form.driver == "SRTMHGT" || form.driver == "DTED" ||
            form.option.find("SPARSE") != std::string::npos) {
            continue;
        }
        const std::string folder = path("cut" + std::to_string(++number));
        std::filesystem::create_directory(folder);
        const std::string file = folder + "/t." + form.ending;
        if (test::writeForm(form, file) && test::valuesOf(file, form.driver)) {
            std::string data = form.driver == "ERS" ? folder + "/t" : form.driver == "ILWIS" ? folder + "/t.mp#" : file;
            // GDAL writes up to 1.75 times the bytes that a header with NBITS=4 says.
            std::filesystem::resize_file(data, std::filesystem::file_size(data) / 2);
            const std::string refused =
                test::refusalOf([&] { (void)scene::loadImporter("test").readDem(file, scene::RasterCheck{}); });
            // AAIGrid is only opened for its units: readEsriGrid() reads its heights.
            EXPECT_NE(refused, "nothing") << form.name();
            tried.insert(form.driver);
        }
        std::filesystem::remove_all(folder);
    }
    EXPECT_GE(tried.size(), 20U);
}

TEST_F(Claims, DecimalCommasInHeadersAreNamedWithTheirLine) {
    writeNumbers("t.flt", std::vector<float>(16, 1));
    write("t.hdr", "ncols 4\nnrows 4\nxllcorner 500000\nyllcorner 5000000\ncellsize 12,5\nbyteorder LSBFIRST\n");
    EXPECT_EQ(refusedRaster("t.flt"), "t.hdr:5: '12,5' has a decimal comma; write a decimal point");
    writeRaster(
        "t.png",
        {.columns = 2, .rows = 2, .heights = {1, 2, 3, 4}, .place = {}, .epsg = 0, .type = GDT_Byte, .driver = "PNG"});
    write("t.pgw", "0,5\n0\n0\n-0,5\n0\n0\n");
    EXPECT_EQ(refusedRaster("t.png"), "t.pgw:1: '0,5' has a decimal comma; write a decimal point");
}

TEST_F(Claims, ASurferTextHasAllItsNumbersAndNoOthers) {
    const std::string head = "DSAA\n3 2\n500005 500025\n5000005 5000015\n1 6\n";
    write("t.grd", head + "1.5 2 3\n4 5 6\n");
    EXPECT_EQ(scene::readRaster(path("t.grd")).at(0, 0), 1.5);
    write("t.grd", head + "1,5 2 3\n4 5 6\n");
    EXPECT_EQ(refusedRaster("t.grd"), "t.grd:6: '1,5' has a decimal comma; write a decimal point");
    write("t.grd", head + "1 2 three\n4 5 6\n");
    EXPECT_EQ(refusedRaster("t.grd"), "t.grd:6: expected a number, got 'three'");
    write("t.grd", head + "1 2 3\n4 5\n");
    EXPECT_EQ(refusedRaster("t.grd"),
              "t.grd: its header says that 3 x 2 = 6 numbers follow, but there are 5; the file may be cut");
    write("t.grd", head + "1 2 3\n4 5 6 7\n");
    EXPECT_NE(refusedRaster("t.grd").find("but there are 7"), std::string::npos);
}

TEST_F(Claims, SignedBytesHaveTheirSign) {
    const auto heights = [&](std::optional<double> noData) {
        writeRaster("t.tif", {.columns = 3,
                              .rows = 1,
                              .heights = {kNegativeByte - 3, 127, kNegativeByte - 128},
                              .type = GDT_Byte,
                              .noData = noData,
                              .options = {"PIXELTYPE=SIGNEDBYTE"}});
        return scene::readRaster(path("t.tif")).heights;
    };
    EXPECT_EQ(heights({}), (std::vector<double>{-3, 127, -128}));
    const scene::RasterHeights masked = heights(-128);
    EXPECT_EQ(masked[0], -3);
    EXPECT_TRUE(std::isnan(masked[2])) << "a number with a sign means no data";
}

TEST_F(Claims, WhiteMayBeZeroInHeightsButNotInPictures) {
    for (const GDALDataType type : {GDT_Byte, GDT_UInt16}) {
        writeRaster(
            "t.tif",
            {.columns = 3, .rows = 1, .heights = {1, 2, 200}, .type = type, .options = {"PHOTOMETRIC=MINISWHITE"}});
        EXPECT_EQ(scene::readRaster(path("t.tif")).heights, (std::vector<double>{1, 2, 200}));
        EXPECT_NE(refusal("[terrain]\nkind = \"image\"\nfile = \"t.tif\"\nhigh = 1\n")
                      .find("t.tif: its 0 is white, so that it could"),
                  std::string::npos);
    }
}

TEST_F(Claims, ATurnOfARoundingErrorIsNone) {
    Raster raster{.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}};
    raster.place = {{1000, 10, 1e-15, 2000, -1e-15, -10}};
    writeRaster("t.tif", raster);
    EXPECT_EQ(scene::readRaster(path("t.tif")).at(0, 0), 4);
    raster.place = {{1000, 10, 0.1, 2000, 0.1, -10}};  // 0.57 degrees
    writeRaster("t.tif", raster);
    EXPECT_NE(refusedRaster("t.tif").find("is turned or mirrored"), std::string::npos);
}

// A scale of 0.1 and an offset of -1000 make the height 0 of the number 10000, and -1000 of 0, which means no data.
TEST_F(Claims, WhatIsWrittenNeverMarksAHeightAsNoData) {
    GDALDriverH driver = GDALGetDriverByName("GTiff");
    GDALDatasetH dataset = GDALCreate(driver, path("t.tif").c_str(), 3, 1, 1, GDT_UInt16, nullptr);
    std::array<double, 6> place{0, 10, 0, 0, 0, -10};
    GDALSetGeoTransform(dataset, place.data());
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    GDALSetRasterNoDataValue(band, 0);
    GDALSetRasterScale(band, 0.1);
    GDALSetRasterOffset(band, -1000);
    std::array<std::uint16_t, 3> numbers{0, 10000, 10010};
    ASSERT_EQ(GDALRasterIO(band, GF_Write, 0, 0, 3, 1, numbers.data(), 3, 1, GDT_UInt16, 0, 0), CE_None);
    GDALClose(dataset);
    const scene::EsriGrid grid = scene::readRaster(path("t.tif"));
    EXPECT_EQ(grid.noData, -1000);
    for (const char* name : {"out.asc", "out.tif"}) {
        scene::writeRaster(grid, path(name));
        const scene::EsriGrid again = scene::readRaster(path(name));
        EXPECT_TRUE(again.isNoData(0, 0)) << name;
        EXPECT_EQ(again.at(1, 0), 0) << name;
        EXPECT_DOUBLE_EQ(again.at(2, 0), 1) << name;
    }
    // The number of the file may also be a height after the sand has moved.
    const scene::EsriGrid moved{3, 1, 1, 0, 0, {std::nan(""), -9999, 7}, std::nullopt, -9999.0};
    scene::writeEsriGrid(moved, path("moved.asc"));
    const scene::EsriGrid read = scene::readEsriGrid(path("moved.asc"));
    EXPECT_TRUE(read.isNoData(0, 0));
    EXPECT_EQ(read.at(1, 0), -9999);
}

TEST_F(Claims, TheLowestFloatIsNoHeightInAnyReader) {
    writeRaster("t.tif", {.columns = 3, .rows = 1, .heights = {-3.4028234663852886e38, 2, 3}});
    write("t.asc", "ncols 2\nnrows 1\ncellsize 1\n-3.40282e+38 1\n");
    write("s.grd", "DSAA\n2 2\n0 10\n0 10\n1 4\n1 2\n3 3.402823e38\n");
    write("surfer.asc", "ncols 2\nnrows 1\ncellsize 1\n1.70141e+38 1\n");
    write("double.asc", "ncols 2\nnrows 1\ncellsize 1\n-1.7976931348623157e+308 1\n");
    write("p.csv", "0,0,1\n1,0,2\n0,1,-3.4028235e38\n");
    for (const auto& [kind, file] : {std::pair{"dem", "t.tif"},
                                     {"dem", "t.asc"},
                                     {"esri_ascii", "t.asc"},
                                     {"dem", "s.grd"},
                                     {"dem", "surfer.asc"},
                                     {"dem", "double.asc"}}) {
        const std::string refused = refusal(fmt::format("[terrain]\nkind = \"{}\"\nfile = \"{}\"\n", kind, file));
        EXPECT_NE(refused.find(", which means no data; declare it: "), std::string::npos) << refused;
        EXPECT_EQ(support::runProgram("sandwall-relax", path(file) + " " + path("out.asc") + " --talus 30").status, 2);
    }
    EXPECT_EQ(refusal("[terrain]\nkind = \"points\"\nfile = \"p.csv\"\n[tin]\n"),
              "p.csv: 1 point has the height -3.4028235e+38, which means no data; leave such lines out");
    std::string scan = "Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 1\n";
    scan.append(4 - scan.size() % 4, '\0');
    for (const float height : {std::numeric_limits<float>::lowest(), 1.F}) {
        scan.append(reinterpret_cast<const char*>(&height), sizeof height);
    }
    write("t.gsf", scan);
    EXPECT_NE(refusal("[terrain]\nkind = \"gsf\"\nfile = \"t.gsf\"\n")
                  .find(", which means no data; declare it: mask these pixels in Gwyddion"),
              std::string::npos);
    writeRaster("t.tif",
                {.columns = 3, .rows = 1, .heights = {-3.4028234663852886e38, 2, 3}, .noData = -3.4028234663852886e38});
    EXPECT_TRUE(scene::readRaster(path("t.tif")).isNoData(0, 0));
}

TEST_F(Claims, AFileWithSeveralVariablesSaysHowToChooseOne) {
    test::ClassicNetcdf file({{"y", 2}, {"x", 2}});
    file.add({"x", {"x"}, {{"units", "m"}}, {5, 15}});
    file.add({"y", {"y"}, {{"units", "m"}}, {5, 15}});
    file.add({"z", {"y", "x"}, {}, {1, 2, 3, 4}});
    file.add({"error", {"y", "x"}, {}, {1, 1, 1, 1}});
    write("t.nc", file.bytes());
    EXPECT_EQ(
        refusedRaster("t.nc"),
        "t.nc: holds 2 variables (z, error), but heights are only one; choose it: gdal_translate NETCDF:\"t.nc\":z "
        "dem.tif");
}

TEST_F(Claims, ATooWideRasterNamesTheLimit) {
    writeRaster("t.tif", {.columns = 20000, .rows = 2, .heights = std::vector<double>(40000, 1)});
    const support::Ran ran =
        support::runProgram("sandwall-relax", path("t.tif") + " " + path("out.asc") + " --talus 30");
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.output.find("t.tif: has 20000 x 2 cells, and 16384 a side is the most"), std::string::npos)
        << ran.output;
    EXPECT_NE(refusal("[terrain]\nkind = \"dem\"\nfile = \"t.tif\"\n").find("at most 16384 a side"), std::string::npos);
}

TEST_F(Claims, EachWarningOfGdalIsPrintedOnce) {
    writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .unit = "ft"});
    // The unit of a band is in a text of XML. GDAL reads the file without it if the XML is damaged.
    std::ifstream stream(path("t.tif"), std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    bytes[bytes.find("</GDALMetadata>")] = '?';
    write("t.tif", bytes);
    const std::vector<std::string> warnings = scene::readRaster(path("t.tif")).warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_TRUE(warnings[0].starts_with(path("t.tif") + ": GDAL warns: ")) << warnings[0];
}

}  // namespace
