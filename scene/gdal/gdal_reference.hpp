// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "scene/gdal/gdal_raster.hpp"
#include "scene/import/importer.hpp"

namespace scene {

/// Returns the units of the raster's lengths and heights: those of its own coordinate system, of the .prj file beside
/// it, or of its axes. Throws base::InputError for degrees, with the command that turns them into metres. Also throws
/// for a .prj file that cannot be read, for unknown units, and for two different units of heights. Returns no warnings.
[[nodiscard]] RasterDescription describe(const GdalRaster& raster);

/// Returns the reference system of a WKT. Throws base::InputError, whose message begins with `file`.
[[nodiscard]] SpatialReference referenceOf(const std::string& crs, const std::string& file);

/// Returns a system in the form of a .prj file, or an empty text if it cannot be said so.
[[nodiscard]] std::string esriTextOf(OGRSpatialReferenceH reference);

/// Returns whether the same coordinates mean the same place in both systems, which lose their vertical parts.
[[nodiscard]] bool haveSamePlaces(OGRSpatialReferenceH a, OGRSpatialReferenceH b);

}  // namespace scene
