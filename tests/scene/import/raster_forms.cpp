// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/import/raster_forms.hpp"

#include <cpl_error.h>
#include <cpl_string.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace test {
namespace {

constexpr int kColumns = 7, kRows = 5;
constexpr double kNoData = 99;

struct Format {
    const char *driver, *ending;
    std::vector<GDALDataType> types;
    std::vector<const char*> options;  // beside the defaults
};

/// The formats with the options that change how numbers are stored. Metadata options are left out.
const std::vector<Format>& formats() {
    static const std::vector<GDALDataType> kAll{GDT_Byte,  GDT_UInt16,  GDT_Int16,  GDT_UInt32,
                                                GDT_Int32, GDT_Float32, GDT_Float64};
    static const std::vector<Format> kFormats{
        {"GTiff",
         "tif",
         kAll,
         {"TILED=YES BLOCKXSIZE=16 BLOCKYSIZE=16", "COMPRESS=LZW",
          "COMPRESS=DEFLATE TILED=YES BLOCKXSIZE=16 BLOCKYSIZE=16", "COMPRESS=PACKBITS", "COMPRESS=LZMA",
          "COMPRESS=ZSTD", "COMPRESS=LERC", "COMPRESS=LZW PREDICTOR=2", "COMPRESS=DEFLATE PREDICTOR=3",
          "ENDIANNESS=BIG", "ENDIANNESS=BIG COMPRESS=LZW PREDICTOR=2", "BIGTIFF=YES", "PIXELTYPE=SIGNEDBYTE",
          "PHOTOMETRIC=MINISWHITE", "NBITS=7", "NBITS=12", "NBITS=16", "SPARSE_OK=TRUE", "TFW=YES PROFILE=BASELINE"}},
        {"AAIGrid",
         "asc",
         {GDT_Byte, GDT_Int16, GDT_Int32, GDT_Float32},
         {"FORCE_CELLSIZE=YES", "DECIMAL_PRECISION=9"}},
        {"SRTMHGT", "hgt", {GDT_Int16}, {}},
        {"PNG", "png", {GDT_Byte, GDT_UInt16}, {"WORLDFILE=YES", "ZLEVEL=1", "NBITS=8"}},
        {"JPEG", "jpg", {GDT_Byte}, {"QUALITY=100", "PROGRESSIVE=ON", "WORLDFILE=YES"}},
        {"JP2OpenJPEG",
         "jp2",
         {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Int32},
         {"QUALITY=100 REVERSIBLE=YES", "CODEC=J2K QUALITY=100 REVERSIBLE=YES"}},
        {"BMP", "bmp", {GDT_Byte}, {"WORLDFILE=YES"}},
        {"HFA", "img", kAll, {"COMPRESSED=YES", "PIXELTYPE=SIGNEDBYTE", "NBITS=4", "BLOCKSIZE=32", "USE_SPILL=YES"}},
        {"EHdr",
         "bil",
         {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Int32, GDT_UInt32, GDT_Float32},
         {"PIXELTYPE=SIGNEDBYTE", "NBITS=4"}},
        {"EHdr", "flt", {GDT_Float32}, {}},
        {"ENVI", "dat", kAll, {"INTERLEAVE=BIL", "INTERLEAVE=BIP", "SUFFIX=ADD"}},
        {"DTED", "dt0", {GDT_Int16}, {}},
        {"USGSDEM", "dem", {GDT_Int16}, {}},
        {"GSAG", "grd", {GDT_Byte, GDT_Int16, GDT_Float32, GDT_Float64}, {}},
        {"GSBG", "grd", {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Float32}, {}},
        {"GS7BG", "grd", {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Float32, GDT_Float64}, {}},
        {"ERS", "ers", kAll, {"PIXELTYPE=SIGNEDBYTE"}},
        {"RST", "rst", {GDT_Byte, GDT_Int16, GDT_Float32}, {}},
        {"SAGA", "sdat", kAll, {}},
        {"PCRaster",
         "map",
         {GDT_Byte, GDT_Int32, GDT_Float32},
         {"PCRASTER_VALUESCALE=VS_SCALAR", "PCRASTER_VALUESCALE=VS_NOMINAL"}},
        {"Terragen", "ter", {GDT_Float32}, {"MINUSERPIXELVALUE=0 MAXUSERPIXELVALUE=100"}},
        {"Leveller", "ter", {GDT_Float32}, {"MINUSERPIXELVALUE=0"}},
        {"BT", "bt", {GDT_Int16, GDT_Int32, GDT_Float32}, {}},
        {"SIGDEM", "sigdem", {GDT_Float64}, {}},
        {"RMF",
         "rsw",
         {GDT_Byte, GDT_Int16, GDT_Int32, GDT_Float64},
         {"MTW=YES", "COMPRESS=LZW", "COMPRESS=DEFLATE", "RMFHUGE=YES", "BLOCKXSIZE=16 BLOCKYSIZE=16"}},
        {"KRO", "kro", {GDT_Byte, GDT_UInt16, GDT_Float32}, {}},
        {"netCDF",
         "nc",
         {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Int32, GDT_Float32, GDT_Float64},
         {"FORMAT=NC2", "FORMAT=NC4", "FORMAT=NC4C", "FORMAT=NC4 COMPRESS=DEFLATE", "WRITE_BOTTOMUP=NO",
          "FORMAT=NC4 WRITE_BOTTOMUP=NO"}},
        {"NITF",
         "ntf",
         {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Int32, GDT_Float32},
         {"ICORDS=U", "BLOCKXSIZE=16 BLOCKYSIZE=16"}},
        {"ROI_PAC", "dem", {GDT_Int16}, {}},
        {"ILWIS", "mpr", {GDT_Byte, GDT_Int16, GDT_Int32, GDT_Float64}, {}},
        {"FIT", "fit", kAll, {"PAGESIZE=16"}},
        {"HF2", "hf2", {GDT_Float32, GDT_Int16}, {"COMPRESS=YES", "BLOCKSIZE=16"}},
    };
    return kFormats;
}

void ignore(CPLErr /*severity*/, CPLErrorNum /*number*/, const char* /*message*/) {}

/// Silences GDAL, which reports each form that it cannot write.
struct Quiet {
    Quiet() { CPLPushErrorHandler(ignore); }
    ~Quiet() { CPLPopErrorHandler(); }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
};

bool isGlobal(const std::string& driver) { return driver == "SRTMHGT" || driver == "DTED"; }

/// Writes all pixels of a band in memory, which cannot fail.
void put(GDALRasterBandH band, void* numbers, int columns, int rows, GDALDataType type) {
    if (GDALRasterIO(band, GF_Write, 0, 0, columns, rows, numbers, columns, rows, type, 0, 0) != CE_None) {
        throw std::runtime_error("GDAL cannot write into memory");
    }
}

/// Returns the raster in memory: whole numbers from 1 to 33, and one cell without data unless there is none.
GDALDatasetH source(const RasterForm& form) {
    const bool tile = isGlobal(form.driver);
    const int columns = tile ? (form.driver == "DTED" ? 121 : 1201) : kColumns;
    const int rows = tile ? columns : kRows;
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("MEM"), "", columns, rows, 1, form.type, nullptr);
    std::array<double, 6> place{500000, 10, 0, 5000050, 0, -10};
    if (form.southFirst) {
        place = {500000, 10, 0, 5000000, 0, 10};
    }
    if (tile) {
        const double cell = 1.0 / (columns - 1);
        place = {10 - cell / 2, cell, 0, 48 + cell / 2, 0, -cell};
    }
    GDALSetGeoTransform(dataset, place.data());
    OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
    OSRImportFromEPSG(reference, tile ? 4326 : 32632);
    GDALSetSpatialRef(dataset, reference);
    OSRDestroySpatialReference(reference);
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    std::vector<double> numbers(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = static_cast<double>(1 + i % 33);
    }
    using NoData = RasterForm::NoData;
    constexpr std::size_t kEmpty = 9;
    if (form.noData == NoData::number) {
        numbers[kEmpty] = kNoData;
        GDALSetRasterNoDataValue(band, kNoData);
    } else if (form.noData == NoData::nan) {
        numbers[kEmpty] = std::numeric_limits<double>::quiet_NaN();
        GDALSetRasterNoDataValue(band, numbers[kEmpty]);
    }
    if (form.scaled) {
        GDALSetRasterScale(band, 0.5);
        GDALSetRasterOffset(band, -8);
    }
    put(band, numbers.data(), columns, rows, GDT_Float64);
    if (form.noData == NoData::mask) {
        GDALCreateDatasetMaskBand(dataset, GMF_PER_DATASET);
        std::vector<unsigned char> known(numbers.size(), 255);
        known[kEmpty] = 0;
        put(GDALGetMaskBand(band), known.data(), columns, rows, GDT_Byte);
    }
    return dataset;
}

const char* nameOf(RasterForm::NoData kind) {
    switch (kind) {
        case RasterForm::NoData::number:
            return "a number";
        case RasterForm::NoData::nan:
            return "nan";
        case RasterForm::NoData::mask:
            return "a mask";
        default:
            return "none";
    }
}

}  // namespace

std::string RasterForm::name() const {
    return driver + " ." + ending + ", " + GDALGetDataTypeName(type) + ", " + (option.empty() ? "defaults" : option) +
           ", no data: " + nameOf(noData) + (scaled ? ", scaled" : "") + (southFirst ? ", south first" : "");
}

std::vector<RasterForm> rasterForms() {
    using NoData = RasterForm::NoData;
    std::vector<RasterForm> forms;
    for (const Format& format : formats()) {
        std::vector<std::string> options{""};
        options.insert(options.end(), format.options.begin(), format.options.end());
        for (const GDALDataType type : format.types) {
            for (const std::string& option : options) {
                const bool floats = type == GDT_Float32 || type == GDT_Float64;
                for (const NoData noData : {NoData::none, NoData::number, NoData::nan, NoData::mask}) {
                    if (noData == NoData::nan && !floats) {
                        continue;
                    }
                    for (const bool scaled : {false, true}) {
                        for (const bool southFirst : {false, true}) {
                            forms.push_back({format.driver, format.ending, type, option, noData, scaled, southFirst});
                        }
                    }
                }
            }
        }
    }
    return forms;
}

std::vector<std::string> formatsThatGdalCannotWrite() { return {"SDTS", "NGSGEOID"}; }

bool writeForm(const RasterForm& form, const std::string& file) {
    const Quiet quiet;
    GDALDriverH driver = GDALGetDriverByName(form.driver.c_str());
    if (driver == nullptr) {
        return false;
    }
    char** options = CSLTokenizeString2(form.option.c_str(), " ", 0);
    GDALDatasetH from = source(form);
    CPLErrorReset();
    GDALDatasetH made = GDALCreateCopy(driver, file.c_str(), from, FALSE, options, nullptr, nullptr);
    GDALClose(made);
    GDALClose(from);
    CSLDestroy(options);
    return made != nullptr && CPLGetLastErrorType() != CE_Failure;
}

std::optional<GdalValues> valuesOf(const std::string& file, const std::string& driver) {
    const Quiet quiet;
    const std::array<const char*, 2> drivers{driver.c_str(), nullptr};
    GDALDatasetH dataset = GDALOpenEx(file.c_str(), GDAL_OF_RASTER, drivers.data(), nullptr, nullptr);
    if (dataset == nullptr || GDALGetRasterCount(dataset) != 1) {
        GDALClose(dataset);
        return std::nullopt;
    }
    GdalValues values;
    values.columns = GDALGetRasterXSize(dataset);
    values.rows = GDALGetRasterYSize(dataset);
    const auto cells = static_cast<std::size_t>(values.columns) * static_cast<std::size_t>(values.rows);
    values.heights.resize(cells);
    std::vector<unsigned char> known(cells);
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    const auto read = [&](GDALRasterBandH from, void* to, GDALDataType type) {
        return GDALRasterIO(from, GF_Read, 0, 0, values.columns, values.rows, to, values.columns, values.rows, type, 0,
                            0) == CE_None;
    };
    const bool good = read(band, values.heights.data(), GDT_Float64) &&
                      read(GDALGetMaskBand(band), known.data(), GDT_Byte) &&
                      GDALGetGeoTransform(dataset, values.place.data()) == CE_None;
    OGRSpatialReferenceH reference = GDALGetSpatialRef(dataset);
    values.degrees = reference != nullptr && OSRIsGeographic(reference) != 0;
    const double scale = GDALGetRasterScale(band, nullptr), offset = GDALGetRasterOffset(band, nullptr);
    for (std::size_t i = 0; i < cells; ++i) {
        const double height = values.heights[i] * scale + offset;
        values.heights[i] = known[i] == 0 ? std::numeric_limits<double>::quiet_NaN() : height;
    }
    if (values.place[5] > 0) {
        for (int row = 0; row < values.rows / 2; ++row) {
            const auto upper = values.heights.begin() + row * values.columns;
            std::swap_ranges(upper, upper + values.columns, values.heights.end() - (row + 1) * values.columns);
        }
    }
    GDALClose(dataset);
    return good ? std::optional(values) : std::nullopt;
}

}  // namespace test
