// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "scene/import/importer.hpp"
#include "scene/model/scene.hpp"
#include "tests/scene/import/import_fixture.hpp"

namespace {

const std::string kImage = "[terrain]\nkind = \"image\"\nfile = \"t.png\"\nwidth = 4\nlow = 1\nhigh = 2\n";

TEST_F(Import, APicturesWhiteIsTheHighestGround) {
    writeRaster(
        "t.png",
        {.columns = 2, .rows = 1, .heights = {0, 255}, .place = {}, .epsg = 0, .type = GDT_Byte, .driver = "PNG"});
    const scene::Scene eight = load(kImage);
    EXPECT_EQ(eight.terrain.cellSize(), 2);
    EXPECT_EQ(eight.terrain.height(0, 0), sand::kUnitsPerCell / 2);
    EXPECT_EQ(eight.terrain.height(1, 0), sand::kUnitsPerCell);
    EXPECT_EQ(eight.georeference, scene::Georeference{}) << "a picture lies nowhere";
    writeRaster(
        "t.png",
        {.columns = 2, .rows = 1, .heights = {0, 65535}, .place = {}, .epsg = 0, .type = GDT_UInt16, .driver = "PNG"});
    EXPECT_TRUE(sameHeights(load(kImage).terrain, eight.terrain)) << "of 16 bits";
    writeRaster("t.png", {.columns = 2, .rows = 1, .heights = {0, 65535}, .place = {}, .epsg = 0, .type = GDT_UInt16});
    EXPECT_TRUE(sameHeights(load(kImage).terrain, eight.terrain)) << "a TIFF, whatever its name";
}

/// Writes grey numbers of `bits` bits as a PNG with libpng.
void writeGreys(const std::string& file, int columns, int rows, int bits, bool interlaced,
                const std::vector<int>& greys) {
    std::FILE* const stream = std::fopen(file.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, static_cast<png_uint_32>(columns), static_cast<png_uint_32>(rows), bits,
                 PNG_COLOR_TYPE_GRAY, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_set_packing(png);  // one byte for each number of less than 8 bits
    const std::size_t size = bits == 16 ? 2 : 1, width = static_cast<std::size_t>(columns);
    std::vector<png_byte> bytes;
    for (const int grey : greys) {
        if (size == 2) {
            bytes.push_back(static_cast<png_byte>(grey >> 8));
        }
        bytes.push_back(static_cast<png_byte>(grey & 255));
    }
    std::vector<png_bytep> starts;
    for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row) {
        starts.push_back(bytes.data() + row * width * size);
    }
    png_write_image(png, starts.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(stream);
}

// GDAL 3.6.2 swaps the bytes of a picture that is interlaced and has 16 bits: it reads 258, which is 0x0102, as 513.
TEST_F(Import, APictureIsReadAlikeInterlacedOrNot) {
    constexpr int kColumns = 11, kRows = 9;  // some pixels in each of the seven passes
    for (const int bits : {1, 2, 4, 8, 16}) {
        const int white = (1 << bits) - 1;
        std::vector<int> greys(kColumns * kRows, white);
        for (int i = 1; i < kColumns * kRows; ++i) {
            greys[static_cast<std::size_t>(i)] = (i * 258 + i) % (white + 1);
        }
        for (const bool interlaced : {false, true}) {
            writeGreys(path("t.png"), kColumns, kRows, bits, interlaced, greys);
            const scene::EsriGrid grid = scene::loadImporter("test").readImage(path("t.png"), scene::Colours::none, {});
            ASSERT_EQ(grid.columns, kColumns);
            ASSERT_EQ(grid.rows, kRows);
            for (std::size_t i = 0; i < greys.size(); ++i) {
                ASSERT_EQ(grid.heights[i], static_cast<double>(greys[i]) / white)
                    << bits << " bits, interlaced " << interlaced << ", pixel " << i;
            }
        }
    }
}

// A world file beside a picture turns it into a DEM. The file holds sizes and the middle of the north-west pixel.
TEST_F(Import, ADemFromAnInterlacedPictureHasItsNumbers) {
    writeGreys(path("t.png"), 2, 2, 16, true, {258, 1, 256, 513});
    write("t.wld", "1000\n0\n0\n-1000\n500\n1500\n");
    const scene::EsriGrid grid = scene::loadImporter("test").readDem(path("t.png"), {});
    EXPECT_EQ(grid.heights, (std::vector<double>{258, 1, 256, 513}));
    EXPECT_EQ(grid.cellSize, 1000);
    EXPECT_EQ(grid.westEdge, 0);
}

// GDAL keeps the no-data number in a file beside the picture. That number refers to the file's own numbers. GDAL may
// read different ones.
TEST_F(Import, TheNumberWithoutDataIsTheFiles) {
    writeGreys(path("t.png"), 2, 2, 16, true, {258, 513, 513, 7});
    write("t.png.aux.xml",
          "<PAMDataset><PAMRasterBand band=\"1\"><NoDataValue>513</NoDataValue></PAMRasterBand></PAMDataset>");
    const scene::EsriGrid grid = scene::loadImporter("test").readImage(path("t.png"), scene::Colours::none, {});
    EXPECT_EQ(grid.heights[0], 258.0 / 65535);
    EXPECT_TRUE(std::isnan(grid.heights[1]));
    EXPECT_TRUE(std::isnan(grid.heights[2]));
    EXPECT_EQ(grid.heights[3], 7.0 / 65535);
}

TEST_F(Import, APictureThatIsCutOffIsOneLine) {
    std::vector<int> greys(64 * 64);
    for (std::size_t i = 0; i < greys.size(); ++i) {
        greys[i] = static_cast<int>(i * 2654435761U % 65536);
    }
    writeGreys(path("t.png"), 64, 64, 16, true, greys);
    std::filesystem::resize_file(path("t.png"), std::filesystem::file_size(path("t.png")) / 2);
    const std::string line = refusal(kImage);
    EXPECT_TRUE(line.starts_with("t.png: ")) << line;
    EXPECT_GT(line.size(), 20U) << line;
}

TEST_F(Import, APhotoBecomesItsBrightnessOnlyIfAskedFor) {
    const std::array<std::uint8_t, 15> pixels{0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255};
    png_image photo{};
    photo.version = PNG_IMAGE_VERSION;
    photo.width = 5;
    photo.height = 1;
    photo.format = PNG_FORMAT_RGB;
    ASSERT_NE(png_image_write_to_file(&photo, path("t.png").c_str(), 0, pixels.data(), 0, nullptr), 0);
    EXPECT_EQ(refusal(kImage),
              "t.png: has 3 bands, but heights are only one; choose it: gdal_translate -b NUMBER t.png dem.tif");
    const scene::EsriGrid grid = scene::loadImporter("test").readImage(path("t.png"), scene::Colours::brightness, {});
    EXPECT_EQ(grid.heights, (std::vector<double>{0, 1, 2126 * 255.0 / 10000 / 255, 7152 * 255.0 / 10000 / 255,
                                                 722 * 255.0 / 10000 / 255}));
    const scene::Scene taken = load(kImage + "brightness = true\n");
    EXPECT_EQ(taken.terrain.height(1, 0), sand::kUnitsPerCell * 2 / 0.8);
    const std::vector<double> greys(64, 100);  // JPEG keeps one grey nearly as it is
    writeRaster("t.jpg", {.columns = 8,
                          .rows = 8,
                          .heights = greys,
                          .place = {},
                          .epsg = 0,
                          .type = GDT_Byte,
                          .driver = "JPEG",
                          .bands = 3});
    const scene::EsriGrid jpeg = scene::loadImporter("test").readImage(path("t.jpg"), scene::Colours::brightness, {});
    EXPECT_NEAR(jpeg.heights[9], 100.0 / 255, 2.0 / 255);
    // A grey picture is its own brightness, with the key as without it.
    writeGreys(path("t.png"), 2, 1, 16, false, {258, 65535});
    EXPECT_TRUE(sameHeights(load(kImage).terrain, load(kImage + "brightness = true\n").terrain));
    // Bands that are not red, green and blue stay several heights.
    writeRaster("t.png", {.columns = 2,
                          .rows = 1,
                          .heights = {0, 255},
                          .place = {},
                          .epsg = 0,
                          .type = GDT_Byte,
                          .bands = 3,
                          .options = {"PHOTOMETRIC=MINISBLACK"}});
    EXPECT_TRUE(refusal(kImage + "brightness = true\n").starts_with("t.png: has 3 bands, ")) << "a TIFF of three greys";
}

TEST_F(Import, PicturesThatAreNoHeightMapsSayWhy) {
    const Raster good{
        .columns = 2, .rows = 1, .heights = {0, 255}, .place = {}, .epsg = 0, .type = GDT_Byte, .driver = "PNG"};
    Raster colours = good;
    colours.bands = 3;
    writeRaster("t.png", colours);
    EXPECT_EQ(refusal(kImage),
              "t.png: has 3 bands, but heights are only one; choose it: gdal_translate -b NUMBER t.png dem.tif");
    writeRaster("t.png", {.columns = 1, .rows = 1, .heights = {1}, .place = {}, .epsg = 0});
    EXPECT_EQ(refusal(kImage),
              "t.png: holds Float32 numbers; an image's are of 8 or 16 bits without sign, and kind = \"dem\" takes "
              "others");
    writeRaster("t.png", good);
    EXPECT_EQ(refusal("[terrain]\nkind = \"image\"\nfile = \"t.png\"\n"), "s.toml:1: [terrain] needs a number 'high'");
    EXPECT_EQ(refusal("[terrain]\nkind = \"image\"\nfile = \"t.png\"\nlow = 2\nhigh = 2\n"),
              "s.toml:5: high must be above low = 2, got 2");
    EXPECT_EQ(refusal("[field]\n" + kImage),
              "s.toml:1: [field] is for flat, dunes and functions; a file brings its own columns, rows and cells");
}

}  // namespace
