// SPDX-License-Identifier: Apache-2.0
// Writes rasters with GDAL's own drivers, and PNG files from chunks.
#include <cpl_conv.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <array>
#include <stdexcept>
#include <vector>

#include "tests/fuzz/png_chunks.hpp"
#include "tests/fuzz/raster_names.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/seeds.hpp"

namespace fuzz {
namespace {

using base::Bytes;

constexpr int kColumns = 8, kRows = 6;

/// A raster to write: its format, its names, and how GDAL writes it.
struct Sample {
    std::uint8_t names;  // index into kRasterNames
    const char* driver;
    GDALDataType type = GDT_Float32;
    int epsg = 32633;  // 0 without a system
    const char* option = nullptr;
    const char* other = nullptr;
};

// The two-letter names fit formats that GDAL recognises by their content.
constexpr std::array kSamples{
    Sample{0, "GTiff"},
    Sample{0, "GTiff", GDT_Float64, 32633, "COMPRESS=DEFLATE", "PREDICTOR=3"},
    Sample{0, "GTiff", GDT_Int16, 4326, "COMPRESS=LZW", "TILED=YES"},
    Sample{0, "GTiff", GDT_Byte, 2264, "COMPRESS=PACKBITS"},
    Sample{3, "GTiff", GDT_UInt16, 0, "TFW=YES", "PROFILE=BASELINE"},
    Sample{4, "AAIGrid"},
    Sample{5, "PNG", GDT_UInt16, 0, "WORLDFILE=YES"},
    Sample{5, "PNG", GDT_Byte, 0, "WORLDFILE=YES"},
    Sample{0, "JPEG", GDT_Byte},
    Sample{0, "JP2OpenJPEG", GDT_UInt16, 32633, "REVERSIBLE=YES", "QUALITY=100"},
    Sample{0, "BMP", GDT_Byte},
    Sample{14, "HFA"},
    Sample{6, "EHdr"},
    Sample{7, "ENVI"},
    Sample{0, "USGSDEM", GDT_Int16, 32633},
    Sample{0, "GSAG"},
    Sample{0, "GSBG"},
    Sample{0, "GS7BG", GDT_Float64},
    Sample{10, "ERS"},
    Sample{9, "RST"},
    Sample{8, "SAGA"},
    Sample{0, "PCRaster"},
    Sample{0, "Terragen", GDT_Float32, 32633, "MINUSERPIXELVALUE=0", "MAXUSERPIXELVALUE=50"},
    Sample{0, "Leveller", GDT_Float32, 32633, "MINUSERPIXELVALUE=0"},
    Sample{0, "BT"},
    Sample{0, "SIGDEM", GDT_Float64},
    Sample{0, "RMF", GDT_Float64},
    Sample{0, "KRO"},
    Sample{0, "netCDF", GDT_Float32, 32633, "FORMAT=NC"},
    Sample{0, "netCDF", GDT_Float32, 32633, "FORMAT=NC4"},
    Sample{0, "NITF", GDT_Float32, 32633},
    Sample{11, "ROI_PAC"},
    Sample{12, "ILWIS"},
    Sample{0, "HF2"},
};

GDALDatasetH inMemory(const Sample& sample) {
    GDALDatasetH raster = GDALCreate(GDALGetDriverByName("MEM"), "", kColumns, kRows, 1, sample.type, nullptr);
    std::array<double, 6> place{1000, 10, 0, 2000, 0, -10};
    GDALSetGeoTransform(raster, place.data());
    if (sample.epsg != 0) {
        OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
        OSRImportFromEPSG(reference, sample.epsg);
        GDALSetSpatialRef(raster, reference);
        OSRDestroySpatialReference(reference);
    }
    std::vector<double> heights(kColumns * kRows);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        heights[i] = static_cast<double>(i * 5 % 37);
    }
    GDALRasterBandH band = GDALGetRasterBand(raster, 1);
    if (sample.names == 0 && sample.option == nullptr) {
        GDALSetRasterNoDataValue(band, 7);
    }
    if (GDALRasterIO(band, GF_Write, 0, 0, kColumns, kRows, heights.data(), kColumns, kRows, GDT_Float64, 0, 0) !=
        CE_None) {
        throw std::runtime_error("GDAL cannot fill a raster");
    }
    return raster;
}

/// Writes one raster as a seed. A format that this GDAL cannot write has no seed.
void write(const Sample& sample, const ScratchFolder& scratch, Folder& folder) {
    GDALDriverH driver = GDALGetDriverByName(sample.driver);
    if (driver == nullptr) {
        return;
    }
    const RasterNames& names = kRasterNames.at(sample.names);
    const std::array<const char*, 3> options{sample.option, sample.option == nullptr ? nullptr : sample.other, nullptr};
    const std::string file = scratch.path() / names.raster;
    GDALDatasetH raster = inMemory(sample);
    GDALDatasetH copy = GDALCreateCopy(driver, file.c_str(), raster, FALSE, options.data(), nullptr, nullptr);
    GDALClose(raster);
    if (copy != nullptr) {
        GDALClose(copy);
        Bytes input = piece(bytesOf(file));
        const Bytes beside = piece(bytesOf(scratch.path() / names.beside));
        input.insert(input.end(), beside.begin(), beside.end());
        folder.add(input, {sample.names});
    }
    scratch.clear();
}

Bytes chunk(std::string_view type, std::initializer_list<int> data) {
    Bytes bytes(type.begin(), type.end());
    for (const int byte : data) {
        bytes.push_back(static_cast<std::uint8_t>(byte));
    }
    return bytes;
}

/// Kinds of pixels, as the header of a PNG numbers them.
enum Colour : std::uint8_t { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };

/// Returns the chunks of a picture of 4 x 2 pixels as pieces. `more` goes before the pixels. A byte before each row of
/// pixels names its filter.
Bytes chunksOfPng(Colour colour, int bits, bool interlaced, const Bytes& more) {
    const int numbers = colour == kRgb ? 3 : colour == kGreyAlpha ? 2 : colour == kRgba ? 4 : 1;
    Bytes rows = chunk("IDAT", {});
    for (int row = 0; row < (interlaced ? 6 : 2); ++row) {
        rows.push_back(static_cast<std::uint8_t>(row % 5));
        for (int i = 0; i < (4 * numbers * bits + 7) / 8; ++i) {
            rows.push_back(static_cast<std::uint8_t>(colour == kPalette ? 1 : 40 * i + row));
        }
    }
    Bytes all;
    for (const Bytes& one : {chunk("IHDR", {0, 0, 0, 4, 0, 0, 0, 2, bits, colour, 0, 0, interlaced ? 1 : 0}), more,
                             rows, chunk("IEND", {})}) {
        const Bytes next = piece(one);
        all.insert(all.end(), next.begin(), next.end());
    }
    return all;
}

}  // namespace

void writeRasters(Folder folder) {
    CPLSetConfigOption("GDAL_DRIVER_PATH", "disable");
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALAllRegister();
    const ScratchFolder scratch;
    for (const Sample& sample : kSamples) {
        write(sample, scratch, folder);
    }
    CPLPopErrorHandler();
}

void writePngs(Folder folder) {
    for (const int bits : {1, 8, 16}) {
        for (const bool interlaced : {false, true}) {
            const Bytes chunks = chunksOfPng(kGrey, bits, interlaced, chunk("tRNS", {0, 40}));
            folder.add(chunks, {2});
            folder.add(pngOf(chunks, true), {0});
        }
    }
    for (const Colour colour : {kRgb, kGreyAlpha, kRgba}) {
        folder.add(chunksOfPng(colour, 8, false, chunk("gAMA", {0, 0, 0xb1, 0x8f})), {2});
        folder.add(chunksOfPng(colour, 16, false, chunk("sBIT", {5, 6, 5, 8})), {2});
    }
    folder.add(chunksOfPng(kPalette, 8, false, chunk("PLTE", {1, 2, 3, 4, 5, 6})), {2});
    folder.add(chunksOfPng(kGrey, 8, false, chunk("tEXt", {'a', 0, 'b'})), {2});
}

}  // namespace fuzz
