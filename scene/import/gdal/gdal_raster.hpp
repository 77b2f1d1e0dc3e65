// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <filesystem>

#include "scene/import/esri_grid.hpp"
#include "scene/import/gdal/gdal_session.hpp"

namespace scene {

/// A local file's one band of numbers, opened and found to be neither too large nor of another kind. Every member
/// throws base::InputError that begins with the file.
class GdalRaster {
public:
    explicit GdalRaster(const std::filesystem::path& file);

    [[nodiscard]] int columns() const { return GDALGetRasterXSize(dataset_.get()); }
    [[nodiscard]] int rows() const { return GDALGetRasterYSize(dataset_.get()); }
    [[nodiscard]] GDALDatasetH dataset() const { return dataset_.get(); }
    [[nodiscard]] GDALRasterBandH band() const { return band_; }
    [[nodiscard]] const std::string& name() const { return name_; }

    /// Returns whether no pixel can be without data: nothing masks any, and whole numbers are always numbers.
    [[nodiscard]] bool complete() const;
    /// Rows as they lie in the file, scale and offset applied; not a number where the file says that nothing is known.
    [[nodiscard]] std::vector<double> pixels() const;
    [[noreturn]] void fail(const std::string& message) const;

private:
    /// The one band beside a mask of opacity.
    void chooseBand();
    [[nodiscard]] bool isPng() const;
    /// Reads the numbers of the band as they stand in the file.
    [[nodiscard]] std::vector<double> numbers() const;
    void mask(std::vector<double>& pixels) const;
    [[noreturn]] void failToRead() const;

    std::string name_;
    GdalSession session_;
    Dataset dataset_;
    GDALRasterBandH band_ = nullptr;
};

}  // namespace scene
