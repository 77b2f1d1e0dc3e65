// SPDX-License-Identifier: Apache-2.0
#include "scene/import/gdal/gdal_geotiff.hpp"

#include <cpl_vsi.h>

#include <array>
#include <limits>

#include "base/input_error.hpp"
#include "scene/import/gdal/gdal_reference.hpp"

namespace scene {
namespace {

// GDAL writes into memory, so that a file on disk is replaced completely or not at all.
constexpr const char* kInMemory = "/vsimem/sandwall.tif";

struct Unlink {
    ~Unlink() { VSIUnlink(kInMemory); }
};

/// Writes place, reference system, units and no-data value. Returns whether all of this succeeded.
bool describe(GDALDatasetH dataset, GDALRasterBandH band, const EsriGrid& grid, const std::string& file) {
    const double depth = grid.cellDepth.value_or(grid.cellSize);
    std::array<double, 6> place{grid.westEdge, grid.cellSize, 0, grid.southEdge + grid.rows * depth, 0, -depth};
    bool good = GDALSetGeoTransform(dataset, place.data()) == CE_None;
    if (!grid.units.crs.empty()) {
        const SpatialReference reference = referenceOf(grid.units.crs, file);
        good = good && GDALSetSpatialRef(dataset, reference.get()) == CE_None;
    }
    if (!grid.units.heightName.empty()) {
        good = good && GDALSetRasterUnitType(band, grid.units.heightName.c_str()) == CE_None;
    }
    // NaN is no-data, because it cannot be a height.
    return good && GDALSetRasterNoDataValue(band, std::numeric_limits<double>::quiet_NaN()) == CE_None;
}

bool fill(GDALRasterBandH band, const EsriGrid& grid) {
    std::vector<double> row(static_cast<std::size_t>(grid.columns));
    for (int fromNorth = 0; fromNorth < grid.rows; ++fromNorth) {
        const double* heights = grid.heights.data() + grid.index(0, grid.rows - 1 - fromNorth);
        for (std::size_t column = 0; column < row.size(); ++column) {
            row[column] = heights[column] * grid.units.heightsPerLength;
        }
        if (GDALRasterIO(band, GF_Write, 0, fromNorth, grid.columns, 1, row.data(), grid.columns, 1, GDT_Float64, 0,
                         0) != CE_None) {
            return false;
        }
    }
    return true;
}

}  // namespace

base::Bytes geoTiffOf(const EsriGrid& grid, const std::string& file) {
    const GdalSession session;
    const auto fail = [&] { throw base::InputError(file + ": cannot be written: " + session.complaint()); };
    const std::array<const char*, 4> options = {"COMPRESS=DEFLATE", "PREDICTOR=3", "BIGTIFF=IF_SAFER", nullptr};
    const Unlink unlink;
    Dataset dataset(
        GDALCreate(GDALGetDriverByName("GTiff"), kInMemory, grid.columns, grid.rows, 1, GDT_Float64, options.data()));
    if (!dataset) {
        fail();
    }
    GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
    if (!describe(dataset.get(), band, grid, file) || !fill(band, grid)) {
        fail();
    }
    dataset.reset();  // writes what is left
    vsi_l_offset length = 0;
    const GByte* bytes = VSIGetMemFileBuffer(kInMemory, &length, FALSE);
    if (bytes == nullptr) {
        fail();
    }
    return {bytes, bytes + length};
}

}  // namespace scene
