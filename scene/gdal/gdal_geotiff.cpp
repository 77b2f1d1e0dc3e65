// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/gdal_geotiff.hpp"

#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "base/input_error.hpp"
#include "scene/gdal/gdal_reference.hpp"
#include "scene/gdal/length_unit.hpp"

namespace scene {
namespace {

// GDAL writes into memory, so that a file on disk is replaced completely or not at all.
constexpr const char* kInMemory = "/vsimem/sandwall.tif";

struct Unlink {
    ~Unlink() { VSIUnlink(kInMemory); }
};

/// Returns whether heights are written in the unit of lengths. A GeoTIFF without a coordinate system does not have the
/// unit of its lengths, so that readers take that of heights for both.
bool writesLengths(const RasterUnits& units) { return units.crs.empty() && units.heightsPerLength != 1; }

/// Returns the unit of heights as the file is to name it; empty without a name.
std::string heightUnitName(const RasterUnits& units) {
    if (!writesLengths(units)) {
        return units.heightName;
    }
    constexpr std::array<const char*, 6> kNames{"m", "km", "ft", "us-ft", "cm", "mm"};
    constexpr double kSame = 1e-9;
    const auto* const found = std::find_if(kNames.begin(), kNames.end(), [&](const char* name) {
        return std::abs(metresOf(name).value_or(0) - units.lengthMetres) <= kSame * units.lengthMetres;
    });
    return found == kNames.end() ? "" : *found;
}

/// Writes place, reference system, units and no-data value. Returns whether all of this succeeded.
bool describe(GDALDatasetH dataset, GDALRasterBandH band, const EsriGrid& grid, const std::string& file) {
    const double depth = grid.cellDepth.value_or(grid.cellSize);
    std::array<double, 6> place{grid.westEdge, grid.cellSize, 0, grid.southEdge + grid.rows * depth, 0, -depth};
    bool good = GDALSetGeoTransform(dataset, place.data()) == CE_None;
    if (!grid.units.crs.empty()) {
        const SpatialReference reference = referenceOf(grid.units.crs, file);
        good = good && GDALSetSpatialRef(dataset, reference.get()) == CE_None;
    }
    if (const std::string unit = heightUnitName(grid.units); !unit.empty()) {
        good = good && GDALSetRasterUnitType(band, unit.c_str()) == CE_None;
    }
    // NaN is no-data, because it cannot be a height.
    return good && GDALSetRasterNoDataValue(band, std::numeric_limits<double>::quiet_NaN()) == CE_None;
}

bool fill(GDALRasterBandH band, const EsriGrid& grid) {
    const double heightsPerLength = writesLengths(grid.units) ? 1 : grid.units.heightsPerLength;
    std::vector<double> row(static_cast<std::size_t>(grid.columns));
    for (int fromNorth = 0; fromNorth < grid.rows; ++fromNorth) {
        const std::size_t first = grid.index(0, grid.rows - 1 - fromNorth);
        for (std::size_t column = 0; column < row.size(); ++column) {
            row[column] = grid.heights[first + column] * heightsPerLength;
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
