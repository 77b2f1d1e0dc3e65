// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.hpp"
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

TEST_F(Import, PicturesThatAreNoHeightMapsSayWhy) {
    const Raster good{
        .columns = 2, .rows = 1, .heights = {0, 255}, .place = {}, .epsg = 0, .type = GDT_Byte, .driver = "PNG"};
    Raster colours = good;
    colours.bands = 3;
    writeRaster("t.png", colours);
    EXPECT_EQ(refusal(kImage), "t.png: has 3 bands, and heights are one; choose it: gdal_translate -b NUMBER");
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
