// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gdal.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace test {

/// One way in which GDAL can write a raster.
struct RasterForm {
    std::string driver, ending;
    GDALDataType type = GDT_Float32;
    std::string option;  // of the driver, "KEY=VALUE" or several with blanks between; empty for its defaults
    enum class NoData { none, number, nan, mask } noData = NoData::none;
    bool scaled = false;      // numbers have a scale and an offset
    bool southFirst = false;  // the first row is the southernmost

    [[nodiscard]] std::string name() const;
};

/// Returns every combination of type, option, no data, scale and order of rows that GDAL may be able to write in a
/// format that terrain is read from.
[[nodiscard]] std::vector<RasterForm> rasterForms();

/// Formats that terrain is read from and that GDAL cannot write.
[[nodiscard]] std::vector<std::string> formatsThatGdalCannotWrite();

/// A raster as GDAL itself reads it: rows from the north, NaN where GDAL's mask says so, scale and offset applied.
struct GdalValues {
    int columns = 0, rows = 0;
    std::vector<double> heights;
    std::array<double, 6> place{};
    bool degrees = false;
};

/// Writes a raster of 7 x 5 cells of 10 m in this form. Returns false if GDAL cannot write it so.
[[nodiscard]] bool writeForm(const RasterForm& form, const std::string& file);
/// Returns nullopt if GDAL cannot read the file.
[[nodiscard]] std::optional<GdalValues> valuesOf(const std::string& file, const std::string& driver);

}  // namespace test
