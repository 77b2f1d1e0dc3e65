// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/gdal/gdal_session.hpp"
#include "scene/import/importer.hpp"
#include "scene/import/raster_check.hpp"
#include "scene/import/steady_files.hpp"

namespace scene {

/// Local file with one band of numbers. The constructor opens it and checks its size and kind. Every member may throw
/// base::InputError, whose message begins with the file.
class GdalRaster {
public:
    /// Opens `inMemory` in place of `file`, unless it is empty. Messages name `file`. With Colours::brightness the file
    /// may have red, green and blue bands, which pixels() weighs.
    explicit GdalRaster(const std::filesystem::path& file, const std::filesystem::path& inMemory = {},
                        Colours colours = Colours::none);

    [[nodiscard]] int columns() const { return GDALGetRasterXSize(dataset_.get()); }
    [[nodiscard]] int rows() const { return GDALGetRasterYSize(dataset_.get()); }
    [[nodiscard]] GDALDatasetH dataset() const { return dataset_.get(); }
    [[nodiscard]] GDALRasterBandH band() const { return band_; }
    [[nodiscard]] const std::string& name() const { return name_; }
    /// Returns GDAL's short name of the format, such as "GTiff".
    [[nodiscard]] std::string driver() const { return GDALGetDriverShortName(GDALGetDatasetDriver(dataset_.get())); }
    /// Returns whether 0 would be drawn white. GDAL then adds a table of greys, which is not a palette.
    [[nodiscard]] bool isWhiteZero() const;
    /// Returns whether the band has a palette in which every number has its own grey, as each BMP of greys has.
    [[nodiscard]] bool isGreyPalette() const;
    /// Returns the number that means no data, as a height: with scale and offset. Returns nullopt if the file declares
    /// none.
    [[nodiscard]] std::optional<double> noData() const;
    [[nodiscard]] bool isPng() const { return driver() == "PNG"; }
    /// Returns whether band() is the first of red, green and blue, whose brightness counts.
    [[nodiscard]] bool isColoured() const { return coloured_; }
    /// Returns whether the numbers are bytes with a sign, which GDAL before 3.7 reads without it.
    [[nodiscard]] bool isSignedByte() const;
    /// Returns the size in which the numbers of the band are exact.
    [[nodiscard]] NumberSize numberSize() const;
    /// Returns the height that a number of the band stands for: with scale and offset.
    [[nodiscard]] double heightOf(double number) const { return isScaled() ? number * scale_ + offset_ : number; }
    /// Returns the files of the raster, the one that was opened first.
    [[nodiscard]] std::vector<std::filesystem::path> files() const;
    /// Returns GDAL's warnings so far, one line each.
    [[nodiscard]] std::vector<std::string> warnings() const { return session_.warnings(name_); }

    /// Returns whether every pixel has data: the file masks no pixel, and its pixels are whole numbers, which are never
    /// NaN.
    [[nodiscard]] bool complete() const;
    /// Returns the rows in the file's order, with scale and offset applied. A pixel without data is NaN.
    /// Calls check.read(). Also throws if a file of the raster has another size afterwards than when it was opened.
    [[nodiscard]] RasterHeights pixels(const RasterCheck& check) const;
    [[noreturn]] void fail(const std::string& message) const;
    /// Throws base::InputError with GDAL's complaint about the pixels.
    [[noreturn]] void failToRead() const;

private:
    /// Chooses the one band that is not a mask of opacity, or the first one of red, green and blue.
    void chooseBand(Colours colours);
    [[noreturn]] void failForVariables() const;
    /// Returns whether the first three bands are red, green and blue.
    [[nodiscard]] bool isRedGreenBlue() const;
    [[nodiscard]] bool isScaled() const { return scale_ != 1 || offset_ != 0; }

    std::string name_;
    GdalSession session_;
    Dataset dataset_;
    GDALRasterBandH band_ = nullptr;
    bool coloured_ = false;          // whether band_ is the first of red, green and blue
    double scale_ = 1, offset_ = 0;  // of the band
    SteadyFiles steady_;             // the files of the raster as they were opened
};

}  // namespace scene
