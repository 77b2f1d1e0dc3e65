// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/import/esri_grid.hpp"

namespace scene {

/// Whether the name asks for a GeoTIFF: .tif or .tiff.
[[nodiscard]] bool namesGeoTiff(const std::filesystem::path& file);

/// Throws base::InputError for a name whose ending promises another format: asked before long work. Names without an
/// ending, .txt, and what is no plain file are ESRI ASCII grids, as readRaster() has them.
void checkRasterName(const std::filesystem::path& file);

/// Reads .asc, .txt, names without an ending and what is no plain file as an ESRI ASCII grid, all else as
/// Importer::readDem() does. Text loads GDAL only where its reference system is wanted and a .prj file beside it has
/// one: then it has units, and degrees are refused. `check` may be empty. Throws base::InputError.
[[nodiscard]] EsriGrid readRaster(const std::filesystem::path& file, bool withReference = false,
                                  const RasterCheck& check = {});

/// Writes a GeoTIFF with units and reference system, heights in its own unit; or for any other name an ESRI ASCII grid,
/// heights in the unit of lengths, and its reference system, where it has one, into a .prj file beside it. What stood
/// there is replaced when all is written. Throws base::InputError.
void writeRaster(const EsriGrid& grid, const std::filesystem::path& file);

}  // namespace scene
