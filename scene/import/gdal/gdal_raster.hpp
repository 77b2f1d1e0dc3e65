// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <filesystem>

#include "scene/import/esri_grid.hpp"
#include "scene/import/gdal/gdal_session.hpp"

namespace scene {

/// Local file with one band of numbers. The constructor opens it and checks its size and kind. Every member may throw
/// base::InputError, whose message begins with the file.
class GdalRaster {
public:
    explicit GdalRaster(const std::filesystem::path& file);

    [[nodiscard]] int columns() const { return GDALGetRasterXSize(dataset_.get()); }
    [[nodiscard]] int rows() const { return GDALGetRasterYSize(dataset_.get()); }
    [[nodiscard]] GDALDatasetH dataset() const { return dataset_.get(); }
    [[nodiscard]] GDALRasterBandH band() const { return band_; }
    [[nodiscard]] const std::string& name() const { return name_; }

    /// Returns whether every pixel has data: the file masks no pixel, and its pixels are whole numbers, which are never
    /// NaN.
    [[nodiscard]] bool complete() const;
    /// Returns the rows in the file's order, with scale and offset applied. A pixel without data is NaN.
    [[nodiscard]] std::vector<double> pixels() const;
    [[noreturn]] void fail(const std::string& message) const;

private:
    /// Chooses the one band that is not a mask of opacity.
    void chooseBand();
    [[nodiscard]] bool isPng() const;
    /// Returns the numbers of the band as the file holds them.
    [[nodiscard]] std::vector<double> numbers() const;
    void mask(std::vector<double>& pixels) const;
    [[noreturn]] void failToRead() const;

    std::string name_;
    GdalSession session_;
    Dataset dataset_;
    GDALRasterBandH band_ = nullptr;
};

}  // namespace scene
