// SPDX-License-Identifier: Apache-2.0
// Files that another program writes to while they are read. Each test changes the file in a call that its reader makes.
#include "scene/import/steady_files.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "scene/import/esri_file.hpp"
#include "scene/import/gsf_file.hpp"
#include "scene/import/importer.hpp"
#include "scene/import/points_file.hpp"
#include "scene/import/raster_file.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/support/refusal.hpp"

namespace {

class SteadyFile : public Import {
protected:
    /// Returns the message about a file that had `before` bytes, and has `after` now.
    [[nodiscard]] std::string changed(const std::string& name, std::uintmax_t before, std::uintmax_t after) const {
        return fmt::format(
            "{}: has changed while it was read: it had {} bytes, and has {} now; wait until the program that writes it "
            "has ended, and start again",
            path(name), before, after);
    }
    /// Gives the file another size as soon as its reader knows how many pixels it has.
    [[nodiscard]] scene::RasterCheck resizing(const std::string& name, std::uintmax_t bytes) const {
        return [=, this](const scene::RasterSize&) { std::filesystem::resize_file(path(name), bytes); };
    }
    [[nodiscard]] std::uintmax_t sizeOf(const std::string& name) const {
        return std::filesystem::file_size(path(name));
    }
};

constexpr int kFileSide = 600;  // of rasters that are longer than the pieces in which files are read

TEST_F(SteadyFile, ARasterOfGdalThatShrinksIsNotReadAsZeros) {
    write("t.hdr", fmt::format("NROWS {0}\nNCOLS {0}\nNBITS 16\nPIXELTYPE SIGNEDINT\nULXMAP 5\nULYMAP 5\nXDIM 10\nYDIM "
                               "10\n",
                               kFileSide));
    write("t.bil", std::string(std::size_t{2} * kFileSide * kFileSide, '\1'));
    const std::uintmax_t whole = sizeOf("t.bil");
    EXPECT_EQ(scene::readRaster(path("t.bil")).at(0, 0), 257);
    EXPECT_EQ(test::refusalOf([&] { (void)scene::readRaster(path("t.bil"), resizing("t.bil", whole / 2)); }),
              changed("t.bil", whole, whole / 2));
}

TEST_F(SteadyFile, AGeoTiffThatShrinksOrGrowsIsOneLine) {
    const Raster raster{
        .columns = kFileSide, .rows = kFileSide, .heights = std::vector<double>(kFileSide * kFileSide, 7)};
    writeRaster("t.tif", raster);
    const std::uintmax_t whole = sizeOf("t.tif");
    for (const std::uintmax_t bytes : {whole / 2, whole + 1}) {
        writeRaster("t.tif", raster);
        EXPECT_EQ(test::refusalOf([&] { (void)scene::readRaster(path("t.tif"), resizing("t.tif", bytes)); }),
                  changed("t.tif", whole, bytes));
    }
}

TEST_F(SteadyFile, APictureThatShrinksIsOneLine) {
    std::vector<double> noise;
    for (std::uint32_t number = 1; noise.size() < std::size_t{kFileSide} * kFileSide;
         number = number * 1664525 + 1013904223) {
        noise.push_back(number >> 24U);
    }
    writeRaster("t.png", {.columns = kFileSide,
                          .rows = kFileSide,
                          .heights = noise,
                          .place = {},
                          .epsg = 0,
                          .type = GDT_Byte,
                          .driver = "PNG"});
    const std::uintmax_t whole = sizeOf("t.png");
    EXPECT_EQ(test::refusalOf([&] {
                  (void)scene::loadImporter("test").readImage(path("t.png"), scene::Colours::none,
                                                              resizing("t.png", whole / 2));
              }),
              changed("t.png", whole, whole / 2));
}

TEST_F(SteadyFile, AScanThatShrinksIsOneLine) {
    std::string scan = fmt::format("Gwyddion Simple Field 1.0\nXRes = {0}\nYRes = {0}\n", kFileSide);
    scan.append(4 - scan.size() % 4, '\0');
    write("t.gsf", scan + std::string(sizeof(float) * kFileSide * kFileSide, '\1'));
    const std::uintmax_t whole = sizeOf("t.gsf");
    EXPECT_EQ(test::refusalOf([&] { (void)scene::readGsf(path("t.gsf"), resizing("t.gsf", whole / 2)); }),
              changed("t.gsf", whole, whole / 2));
}

// Cut within its last number, the text has as many numbers as before.
TEST_F(SteadyFile, ATextThatShrinksIsOneLineEvenIfItHasAllItsNumbers) {
    std::string text = fmt::format("ncols {0}\nnrows {0}\ncellsize 1\n", kFileSide);
    for (int i = 1; i < kFileSide * kFileSide; ++i) {
        text += "1 ";
    }
    text += "12";
    for (const std::size_t bytes : {text.size() / 2, text.size() - 1}) {
        write("t.asc", text);
        EXPECT_EQ(test::refusalOf([&] { (void)scene::readEsriGrid(path("t.asc"), resizing("t.asc", bytes)); }),
                  changed("t.asc", text.size(), bytes));
    }
}

TEST_F(SteadyFile, PointsThatShrinkAreOneLine) {
    std::string points;
    for (int i = 0; i < kFileSide * kFileSide; ++i) {
        points += fmt::format("{},{},1\n", i % kFileSide, i / kFileSide);
    }
    write("p.csv", points);
    const std::uintmax_t bytes = points.size() / 2 + 1;
    const auto shrink = [&](double /*share*/) { std::filesystem::resize_file(path("p.csv"), bytes); };
    EXPECT_EQ(test::refusalOf([&] { (void)scene::readPoints(path("p.csv"), shrink); }),
              changed("p.csv", points.size(), bytes));
}

TEST_F(SteadyFile, AFileThatIsGoneWhileItIsReadIsReadToItsEnd) {
    write("t.asc", "ncols 2\nnrows 1\ncellsize 1\n1 2\n");
    const auto remove = [&](const scene::RasterSize&) { std::filesystem::remove(path("t.asc")); };
    EXPECT_EQ(scene::readEsriGrid(path("t.asc"), remove).at(1, 0), 2);
}

TEST_F(SteadyFile, OtherRefusalsOfAnUnchangedFileStay) {
    const scene::SteadyFiles steady({write("t.txt", "text")});
    EXPECT_EQ(steady.read([] { return 5; }), 5);
    EXPECT_EQ(test::refusalOf([&] { (void)steady.read([]() -> int { throw base::InputError("its own"); }); }),
              "its own");
}

}  // namespace
