// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/byte_stream.hpp"
#include "scene/import/esri_grid.hpp"

namespace scene {

/// Function z = f(x, y) as text, over a rectangle that is divided into cells.
struct Function {
    std::string text;
    double west = 0, east = 1, south = 0, north = 1;  // sides of the rectangle [function's unit]
    int columns = 1, rows = 1;
};

/// Units of a raster, without its pixels.
struct RasterDescription {
    RasterUnits units;
    UnitOrigins origins;
    std::vector<std::string> warnings;  // of GDAL, one line each, with the file's name
};

/// What readImage() does with the colours of a photo.
enum class Colours { none /* refuses them */, brightness /* takes their brightness */ };

/// Functions of the module that loads GDAL and muParser. Call them from one thread at a time.
///
/// All of them throw base::InputError with one line. It names the file, or the place in the function's text, the cause,
/// and what to do if there is a remedy.
class Importer {
public:
    virtual ~Importer() = default;
    Importer() = default;
    Importer(const Importer&) = delete;
    Importer& operator=(const Importer&) = delete;

    /// Reads one band of heights with a place, from a local file. Its format must neither use the network nor run code.
    /// Heights are returned in the unit of lengths; pixels are areas; pixels that the file masks are NaN. Refuses
    /// degrees, turned rasters, files that are shorter than their header says, and rasters beyond kMostRasterBytes.
    /// These checks, and `check` unless it is empty, come before pixels are read.
    [[nodiscard]] virtual EsriGrid readDem(const std::filesystem::path& file, const RasterCheck& check) const = 0;

    /// Returns the units of readDem()'s lengths and heights without reading pixels. For a text grid they come from the
    /// .prj file beside it. Refuses degrees.
    [[nodiscard]] virtual RasterDescription readUnits(const std::filesystem::path& file) const = 0;

    /// Reads one band of 8 or 16 bits without a place. Heights are shares of the largest number, from 0 to 1, and cells
    /// have side 1. With Colours::brightness it also takes red, green and blue bands, and weighs them as ITU-R BT.709
    /// does. Calls `check` as readDem() does.
    [[nodiscard]] virtual EsriGrid readImage(const std::filesystem::path& file, Colours colours,
                                             const RasterCheck& check) const = 0;

    /// Returns the function's values at the middle of every cell. Refuses a value that is not finite, with x and y.
    /// Calls check.read().
    [[nodiscard]] virtual EsriGrid evaluate(const Function& function, const RasterCheck& check) const = 0;

    /// Returns a GeoTIFF of one band of doubles, as bytes. `file` is for messages.
    [[nodiscard]] virtual base::Bytes geoTiff(const EsriGrid& grid, const std::string& file) const = 0;

    /// Returns a coordinate reference system in the form of the .prj file beside an ESRI ASCII grid.
    [[nodiscard]] virtual std::string esriWkt(const std::string& crs, const std::string& file) const = 0;

    /// Returns whether two coordinate reference systems in WKT have the same horizontal part, in whatever words.
    /// `file` is for messages.
    [[nodiscard]] virtual bool sameSystem(const std::string& one, const std::string& other,
                                          const std::string& file) const = 0;
};

/// Largest memory of a raster's heights, so that doubles for a field of the largest sides just fit.
inline constexpr double kMostRasterBytes = 2147483648.0;

/// Symbol that the module defines, with C linkage. It returns the one object, which is never deleted.
inline constexpr const char* kImportSymbol = "sandwallImport8";
using GetImporter = const Importer*();

/// Loads sandwall-import.so from the folder of this program. Returns the same object at every call. Only this function
/// loads GDAL and muParser. Throws base::InputError if the module is missing. The message begins with `what`, which
/// needs it.
[[nodiscard]] const Importer& loadImporter(std::string_view what);

}  // namespace scene
