// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/gdal_raster.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/input_error.hpp"
#include "scene/gdal/claims.hpp"
#include "scene/gdal/png_greys.hpp"
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

GdalRaster::GdalRaster(const fs::path& file, const fs::path& inMemory)
    : name_(file.string()),
      dataset_(GDALOpenEx((inMemory.empty() ? checked(file) : inMemory).c_str(),
                          GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                          static_cast<const char* const*>(kDrivers), nullptr, nullptr)) {
    if (!dataset_) {
        fail("cannot be read as a raster: " + withoutPath(session_.complaint(), fs::absolute(file)) +
             missingHeader(file));
    }
    chooseBand();
    checkClaims(*this);
    const double bytes = kRasterBytesPerPixel * columns() * rows();
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

void GdalRaster::chooseBand() {
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
    if (values != 1) {
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

double GdalRaster::heightOf(double number) const {
    return scale_ == 1 && offset_ == 0 ? number : number * scale_ + offset_;
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

std::vector<double> GdalRaster::numbers(const RasterCheck& check) const {
    if (isPng()) {
        return greysOfPng(name_, columns(), rows());
    }
    std::vector<double> numbers(static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()));
    GDALRasterIOExtraArg more;
    INIT_RASTERIO_EXTRA_ARG(more);
    more.pfnProgress = [](double share, const char* /*message*/, void* to) {
        static_cast<const RasterCheck*>(to)->read(share);
        return TRUE;
    };
    more.pProgressData = const_cast<RasterCheck*>(&check);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    if (GDALRasterIOEx(band_, GF_Read, 0, 0, columns(), rows(), numbers.data(), columns(), rows(), GDT_Float64, 0, 0,
                       &more) != CE_None) {
        failToRead();
    }
    if (isSignedByte()) {
        for (double& number : numbers) {
            number -= number > 127 ? 256 : 0;
        }
    }
    return numbers;
}

std::vector<double> GdalRaster::pixels(const RasterCheck& check) const {
    std::vector<double> pixels = numbers(check);
    mask(pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = heightOf(pixels[i]);
        if (std::isinf(pixels[i])) {
            const auto width = static_cast<std::size_t>(columns());
            fail(
                fmt::format("the height of pixel {}, {} (from the north-west) is infinite; mask it: gdal_translate "
                            "-a_nodata {}",
                            i % width + 1, i / width + 1, pixels[i]));
        }
    }
    return pixels;
}

void GdalRaster::mask(std::vector<double>& pixels) const {
    const int flags = GDALGetMaskFlags(band_);
    if (isSignedByte() || (isPng() && (flags & GMF_NODATA) != 0)) {
        // GDAL's mask would compare the number without its sign, or a transparent grey as GDAL has read it.
        int declared = 0;
        const double noData = GDALGetRasterNoDataValue(band_, &declared);
        if (declared != 0) {
            std::replace(pixels.begin(), pixels.end(), noData, std::numeric_limits<double>::quiet_NaN());
            return;
        }
    }
    if ((flags & GMF_ALL_VALID) != 0) {
        return;
    }
    GDALRasterBandH mask = GDALGetMaskBand(band_);
    std::vector<unsigned char> known(static_cast<std::size_t>(columns()));
    for (int row = 0; row < rows(); ++row) {
        if (GDALRasterIO(mask, GF_Read, 0, row, columns(), 1, known.data(), columns(), 1, GDT_Byte, 0, 0) != CE_None) {
            failToRead();
        }
        for (std::size_t column = 0; column < known.size(); ++column) {
            if (known[column] == 0) {
                pixels[static_cast<std::size_t>(row) * known.size() + column] =
                    std::numeric_limits<double>::quiet_NaN();
            }
        }
    }
}

}  // namespace scene
