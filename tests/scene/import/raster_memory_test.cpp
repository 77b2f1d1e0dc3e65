// SPDX-License-Identifier: Apache-2.0
// The memory that the pixels of a raster take while they are read.
#include <cmath>
#include <fstream>
#include <string>

#include "scene/import/raster_file.hpp"
#include "tests/scene/import/import_fixture.hpp"

namespace {

using scene::NumberSize;

/// Returns a line of /proc/self/status such as VmHWM, the largest resident memory since it was reset [byte].
std::int64_t ownMemory(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        if (word == name + ":") {
            std::int64_t kilobytes = 0;
            status >> kilobytes;
            return kilobytes * 1024;
        }
    }
    return -1;
}

/// Resets VmHWM to the memory that is resident now. Returns false if the kernel does not allow it.
bool resetLargest() {
    std::ofstream clear("/proc/self/clear_refs");
    clear << 5 << std::flush;
    return clear.good() && ownMemory("VmHWM") > 0;
}

TEST_F(Import, TheSizeOfARastersNumbersFollowsFromTheirType) {
    for (const auto& [type, expected] : {std::pair{GDT_Byte, NumberSize::floats},
                                         {GDT_Int16, NumberSize::floats},
                                         {GDT_UInt16, NumberSize::floats},
                                         {GDT_Float32, NumberSize::floats},
                                         {GDT_Int32, NumberSize::doubles},
                                         {GDT_UInt32, NumberSize::doubles},
                                         {GDT_Float64, NumberSize::doubles}}) {
        writeRaster("t.tif", {.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}, .type = type});
        std::int64_t bytes = 0;
        const auto check = [&](const scene::RasterSize& size) {
            EXPECT_EQ(size.numbers, expected) << GDALGetDataTypeName(type);
            bytes = size.bytes();
        };
        EXPECT_EQ(scene::readRaster(path("t.tif"), check).at(2, 0), 6);
        EXPECT_EQ(bytes, 6 * scene::bytesOf(expected));
    }
}

TEST_F(Import, TheLargestNumbersOfEachTypeAreReadExactly) {
    const auto northWest = [&](GDALDataType type, double number) {
        writeRaster("t.tif", {.columns = 2, .rows = 1, .heights = {number, 0}, .type = type});
        return scene::readRaster(path("t.tif")).at(0, 0);
    };
    EXPECT_EQ(northWest(GDT_UInt16, 65535), 65535);
    EXPECT_EQ(northWest(GDT_Int16, -32767), -32767);
    EXPECT_EQ(northWest(GDT_Int32, 16777217), 16777217) << "no float is this number";
    EXPECT_EQ(northWest(GDT_UInt32, 4294967295), 4294967295);
    EXPECT_EQ(northWest(GDT_Float64, 0.1), 0.1);
    EXPECT_EQ(northWest(GDT_Float32, 0.1), double{0.1F});
}

// A stripe has 127 rows here, and GDAL reads blocks of 256.
TEST_F(Import, BlocksThatAreHigherThanAStripeAreReadExactly) {
    constexpr int kWide = 8200, kHigh = 600;
    const auto number = [](int x, int y) { return double((x * 7 + y * 13) % 251); };
    Raster raster{
        .columns = kWide, .rows = kHigh, .heights = {}, .type = GDT_Byte, .noData = 5, .options = {"TILED=YES"}};
    for (int y = 0; y < kHigh; ++y) {
        for (int x = 0; x < kWide; ++x) {
            raster.heights.push_back(number(x, y));
        }
    }
    writeRaster("t.tif", raster);
    const scene::EsriGrid grid = scene::readRaster(path("t.tif"));
    for (int y = 0; y < kHigh; ++y) {
        for (int x = 0; x < kWide; ++x) {
            const double height = grid.at(x, kHigh - 1 - y);
            ASSERT_TRUE(number(x, y) == 5 ? std::isnan(height) : height == number(x, y)) << x << ", " << y;
        }
    }
}

// The raster has an edge without data, which is cut off. A copy of it would take 4 bytes more for each pixel, and a
// band of doubles 8. GDAL and a stripe of rows take less than 24 MiB.
TEST_F(Import, ReadingTakesFourBytesForEachPixelOfFloats) {
    constexpr int kSide = 4096;
    constexpr std::int64_t kPixels = std::int64_t{kSide} * kSide;
    constexpr std::int64_t kBeside = std::int64_t{24} << 20;
    static_assert(kBeside < 2 * kPixels, "so that this test can fail");
    std::vector<double> row(kSide, 7);
    row[0] = -1;
    writeRaster("small.tif", {.columns = 2, .rows = 1, .heights = {1, 2}});
    (void)scene::readRaster(path("small.tif"));  // maps GDAL
    const Raster raster{.columns = kSide, .rows = kSide, .heights = {}, .type = GDT_Int16, .noData = -1};
    writeRaster("t.tif", raster);
    GDALDatasetH dataset = GDALOpen(path("t.tif").c_str(), GA_Update);
    for (int y = 0; y < kSide; ++y) {
        ASSERT_EQ(GDALRasterIO(GDALGetRasterBand(dataset, 1), GF_Write, 0, y, kSide, 1, row.data(), kSide, 1,
                               GDT_Float64, 0, 0),
                  CE_None);
    }
    GDALClose(dataset);
    if (!resetLargest()) {
        GTEST_SKIP() << "this kernel cannot reset the largest resident memory";
    }
    const std::int64_t before = ownMemory("VmRSS");
    const scene::EsriGrid grid = scene::withoutEmptyEdges(scene::readRaster(path("t.tif")));
    EXPECT_EQ(grid.columns, kSide - 1);
    EXPECT_LT(ownMemory("VmHWM") - before, 4 * kPixels + kBeside);
}

}  // namespace
