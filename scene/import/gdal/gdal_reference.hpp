// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "scene/import/gdal/gdal_raster.hpp"

namespace scene {

/// Returns the units of the raster's lengths and heights. Throws base::InputError for degrees, with the command that
/// turns them into metres, and for unknown height units.
[[nodiscard]] RasterUnits unitsOf(const GdalRaster& raster);

/// Returns the reference system of a WKT. Throws base::InputError, whose message begins with `file`.
[[nodiscard]] SpatialReference referenceOf(const std::string& crs, const std::string& file);

}  // namespace scene
