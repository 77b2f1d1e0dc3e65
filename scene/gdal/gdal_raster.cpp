// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/gdal_raster.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/input_error.hpp"
#include "scene/gdal/claims.hpp"
#include "scene/gdal/gdal_pixels.hpp"
#include "scene/import/importer.hpp"

namespace scene {
namespace {

namespace fs = std::filesystem;

// Formats whose files contain their own numbers. The list leaves out formats that use a network, need a database, or
// refer to other files: VRT and similar ones can name servers, and programs in Python. It also leaves out texts in
// which GDAL 3.6.2 reads a word as the height 0: GRASSASCIIGrid, XYZ, ZMap and GXF. AAIGrid stays because of the units
// beside an ESRI ASCII grid; this project's own reader reads the heights.
constexpr const char* kDrivers[] = {
    "GTiff",  "AAIGrid",  "SRTMHGT",  "PNG",      "JPEG", "JP2OpenJPEG", "BMP",   "HFA",      "EHdr",
    "ENVI",   "DTED",     "USGSDEM",  "SDTS",     "GSAG", "GSBG",        "GS7BG", "ERS",      "RST",
    "SAGA",   "PCRaster", "Terragen", "Leveller", "BT",   "SIGDEM",      "RMF",   "NGSGEOID", "KRO",
    "netCDF", "NITF",     "ROI_PAC",  "ILWIS",    "FIT",  "HF2",         nullptr,
};

constexpr int kColours = 3;  // of a photo

fs::path checked(const fs::path& file) {
    std::error_code none;
    if (!fs::is_regular_file(file, none)) {
        throw base::InputError(file.string() + ": cannot be read; check the path");
    }
    // GDAL does not take a name with a leading slash for a driver's prefix.
    return fs::absolute(file);
}

/// Returns GDAL's complaint without the path or the name of the file, with which some drivers begin it once or twice,
/// and without a full stop.
std::string withoutPath(std::string complaint, const fs::path& file) {
    for (bool found = true; found;) {
        found = false;
        for (const std::string& name : {file.string(), file.filename().string()}) {
            for (const std::string& begin : {"`" + name + "' ", name + ": ", name + ":"}) {
                if (complaint.starts_with(begin)) {
                    complaint.erase(0, begin.size());
                    found = true;
                }
            }
        }
    }
    while (complaint.ends_with('.')) {
        complaint.pop_back();
    }
    return complaint;
}

}  // namespace

GdalRaster::GdalRaster(const fs::path& file, const fs::path& inMemory, Colours colours)
    : name_(file.string()),
      dataset_(GDALOpenEx((inMemory.empty() ? checked(file) : inMemory).c_str(),
                          GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                          static_cast<const char* const*>(kDrivers), nullptr, nullptr)) {
    if (!dataset_) {
        fail("cannot be read as a raster: " + withoutPath(session_.complaint(), fs::absolute(file)) +
             missingHeader(file));
    }
    std::vector<fs::path> names = files();
    if (!names.empty()) {
        names[0] = file;  // messages name it as the user does
    }
    steady_ = SteadyFiles(names);
    chooseBand(colours);
    checkClaims(*this);
    const auto bytes = static_cast<double>(RasterSize{columns(), rows(), numberSize()}.bytes());
    if (bytes > kMostRasterBytes) {
        fail(
            fmt::format("{} x {} pixels would take {:.1f} GB, and {:.1f} GB is the most; coarsen it: gdal_translate "
                        "-r average -outsize {:.0f}% 0 {} coarser.tif",
                        columns(), rows(), bytes / 1e9, kMostRasterBytes / 1e9,
                        std::floor(100 * std::sqrt(kMostRasterBytes / bytes)), file.filename().string()));
    }
}

void GdalRaster::fail(const std::string& message) const { throw base::InputError(name_ + ": " + message); }

void GdalRaster::failToRead() const { fail("its pixels cannot be read: " + session_.complaint()); }

void GdalRaster::chooseBand(Colours colours) {
    int values = 0;
    for (int number = GDALGetRasterCount(dataset_.get()); number >= 1; --number) {
        GDALRasterBandH band = GDALGetRasterBand(dataset_.get(), number);
        if (GDALGetRasterColorInterpretation(band) != GCI_AlphaBand) {
            band_ = band;
            ++values;
        }
    }
    if (values == 0) {
        failForVariables();
    }
    scale_ = GDALGetRasterScale(band_, nullptr);
    offset_ = GDALGetRasterOffset(band_, nullptr);
    coloured_ = colours == Colours::brightness && values == kColours && isRedGreenBlue();
    if (values != 1 && !coloured_) {
        fail(fmt::format("has {} bands, but heights are only one; choose it: gdal_translate -b NUMBER {} dem.tif",
                         values, fs::path(name_).filename().string()));
    }
    if (GDALGetRasterColorTable(band_) != nullptr && !isWhiteZero() && !isGreyPalette()) {
        fail("holds colours from a palette instead of heights");
    }
    if (GDALDataTypeIsComplex(GDALGetRasterDataType(band_)) != 0) {
        fail("holds complex numbers instead of heights");
    }
}

void GdalRaster::failForVariables() const {
    std::vector<std::string> names;
    char** const items = GDALGetMetadata(dataset_.get(), "SUBDATASETS");
    for (char** item = items; item != nullptr && *item != nullptr; ++item) {
        const std::string text = *item;
        if (const std::size_t at = text.find("_NAME="); at != std::string::npos) {
            names.push_back(text.substr(at + std::string_view("_NAME=").size()));
        }
    }
    if (names.empty()) {
        fail("holds no band of numbers; list what it holds with gdalinfo");
    }
    std::string variables;
    constexpr std::size_t kMost = 6;
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) {
        variables += (i == 0 ? "" : ", ") + names[i].substr(names[i].rfind(':') + 1);
    }
    std::string first = names[0];
    if (const std::size_t at = first.find(fs::absolute(name_).string()); at != std::string::npos) {
        first.replace(at, fs::absolute(name_).string().size(), fs::path(name_).filename().string());
    }
    fail(fmt::format("holds {} variables ({}{}), but heights are only one; choose it: gdal_translate {} dem.tif",
                     names.size(), variables, names.size() > kMost ? ", ..." : "", first));
}

bool GdalRaster::isRedGreenBlue() const {
    constexpr GDALColorInterp kOrder[kColours] = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    for (int colour = 0; colour < kColours; ++colour) {
        if (GDALGetRasterColorInterpretation(GDALGetRasterBand(dataset_.get(), colour + 1)) != kOrder[colour]) {
            return false;
        }
    }
    return true;
}

bool GdalRaster::isWhiteZero() const {
    const char* const mark = GDALGetMetadataItem(dataset_.get(), "MINISWHITE", "IMAGE_STRUCTURE");
    return mark != nullptr && std::string_view(mark) == "YES";
}

bool GdalRaster::isGreyPalette() const {
    GDALColorTableH table = GDALGetRasterColorTable(band_);
    for (int i = 0; i < GDALGetColorEntryCount(table); ++i) {
        const GDALColorEntry* const entry = GDALGetColorEntry(table, i);
        if (entry->c1 != i || entry->c2 != i || entry->c3 != i) {
            return false;
        }
    }
    return true;
}

bool GdalRaster::isSignedByte() const {
    const char* const type = GDALGetMetadataItem(band_, "PIXELTYPE", "IMAGE_STRUCTURE");
    return GDALGetRasterDataType(band_) == GDT_Byte && type != nullptr && std::string_view(type) == "SIGNEDBYTE";
}

NumberSize GdalRaster::numberSize() const {
    const GDALDataType type = GDALGetRasterDataType(band_);
    const bool shortInteger = GDALDataTypeIsInteger(type) != 0 && GDALGetDataTypeSizeBits(type) <= 16;
    return !coloured_ && (type == GDT_Float32 || shortInteger) ? NumberSize::floats : NumberSize::doubles;
}

std::vector<fs::path> GdalRaster::files() const {
    const GdalList list(GDALGetFileList(dataset_.get()));
    std::vector<fs::path> files;
    for (char** name = list.get(); name != nullptr && *name != nullptr; ++name) {
        files.emplace_back(*name);
    }
    return files;
}

std::optional<double> GdalRaster::noData() const {
    int declared = 0;
    const double number = GDALGetRasterNoDataValue(band_, &declared);
    return declared == 0 ? std::nullopt : std::optional(heightOf(number));
}

bool GdalRaster::complete() const {
    const bool whole = GDALDataTypeIsInteger(GDALGetRasterDataType(band_)) != 0;
    return whole && !isSignedByte() && (GDALGetMaskFlags(band_) & GMF_ALL_VALID) != 0;
}

RasterHeights GdalRaster::pixels(const RasterCheck& check) const {
    RasterHeights heights = steady_.read([&] { return numbersOf(*this, check); });
    if (isScaled()) {
        heights.multiply(scale_, offset_);
    }
    return heights;
}

}  // namespace scene
