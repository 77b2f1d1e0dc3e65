// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/byte_stream.hpp"
#include "scene/import/esri_grid.hpp"

namespace scene {

/// z = f(x, y) as text, over a rectangle that is cut into cells.
struct Function {
    std::string text;
    double west = 0, east = 1, south = 0, north = 1;  // of the rectangle [function's unit]
    int columns = 1, rows = 1;
};

/// The functions of the module that brings GDAL and muParser. One thread at a time.
///
/// All of them throw base::InputError: one line that names the file, or the place in the function's text, the cause,
/// and where there is something to be done, what.
class Importer {
public:
    virtual ~Importer() = default;
    Importer() = default;
    Importer(const Importer&) = delete;
    Importer& operator=(const Importer&) = delete;

    /// Reads one band of heights with a place: a local file of a format that neither reaches for the network nor runs
    /// anything. Heights come in the unit of lengths; pixels are areas; what the file masks is not a number. Refuses
    /// degrees, turned rasters, and those beyond kMostRasterBytes. These, and `check` unless it is empty, are asked
    /// before pixels are read.
    [[nodiscard]] virtual EsriGrid readDem(const std::filesystem::path& file, const RasterCheck& check) const = 0;

    /// What readDem()'s lengths and heights are, without reading pixels: of a text grid what stands in the .prj file
    /// beside it. Refuses degrees.
    [[nodiscard]] virtual RasterUnits readUnits(const std::filesystem::path& file) const = 0;

    /// Reads one band of 8 or 16 bits without a place: heights are shares of the largest number, 0 to 1, and cells have
    /// side 1. Calls `check` as readDem() does.
    [[nodiscard]] virtual EsriGrid readImage(const std::filesystem::path& file, const RasterCheck& check) const = 0;

    /// At the middle of every cell. Refuses what is not finite, with x and y.
    [[nodiscard]] virtual EsriGrid evaluate(const Function& function) const = 0;

    /// A GeoTIFF of one band of doubles, as bytes. `file` is for messages.
    [[nodiscard]] virtual base::Bytes geoTiff(const EsriGrid& grid, const std::string& file) const = 0;

    /// A coordinate reference system as it stands in the .prj file beside an ESRI ASCII grid.
    [[nodiscard]] virtual std::string esriWkt(const std::string& crs, const std::string& file) const = 0;
};

/// What a raster may take in memory: 16 bytes a pixel, so that a field of the largest sides just fits.
inline constexpr double kRasterBytesPerPixel = 16;
inline constexpr double kMostRasterBytes = 4294967296.0;

/// What the module defines, with C linkage: the one object, never deleted.
inline constexpr const char* kImportSymbol = "sandwallImport3";
using GetImporter = const Importer*();

/// Loads sandwall-import.so from beside this program; the same object at every call. Nothing else maps GDAL or
/// muParser. Throws base::InputError that begins with `what`, for which it is needed, when it is missing.
[[nodiscard]] const Importer& loadImporter(const std::string& what);

}  // namespace scene
