// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "scene/import/gdal/gdal_raster.hpp"

namespace scene {

/// What the raster's lengths and heights are. Throws base::InputError: degrees, with the command that makes metres of
/// them, and height units nobody knows.
[[nodiscard]] RasterUnits unitsOf(const GdalRaster& raster);

/// The reference system of a WKT. Throws base::InputError, which begins with `file`.
[[nodiscard]] SpatialReference referenceOf(const std::string& crs, const std::string& file);

}  // namespace scene
