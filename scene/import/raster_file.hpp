// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/import/esri_grid.hpp"

namespace scene {

class Importer;

/// Whether the name asks for a GeoTIFF: .tif or .tiff.
[[nodiscard]] bool namesGeoTiff(const std::filesystem::path& file);

/// Throws base::InputError for a name whose ending promises another format: asked before long work. Names without an
/// ending, .txt, and what is no plain file are ESRI ASCII grids, as readRaster() has them.
void checkRasterName(const std::filesystem::path& file);

/// Reads heights in any format. A file that holds an ESRI ASCII grid, or is named .asc, .txt or without an ending, and
/// what is no plain file, is read by readEsriGrid(). Other files are read by Importer::readDem(). Text loads GDAL only
/// if its reference system is wanted and a .prj file beside it has one: then it has units, and degrees are refused.
/// `check` may be empty. Throws base::InputError.
[[nodiscard]] EsriGrid readRaster(const std::filesystem::path& file, bool withReference = false,
                                  const RasterCheck& check = {});

/// Reads a raster by Importer::readDem(), and adds warnings of its heights. Throws base::InputError.
[[nodiscard]] EsriGrid readByGdal(const std::filesystem::path& file, const Importer& importer,
                                  const RasterCheck& check = {});

/// Reads an ESRI ASCII grid with the units that `importer` finds in it and beside it. Throws base::InputError.
[[nodiscard]] EsriGrid readTextWithUnits(const std::filesystem::path& file, const Importer& importer,
                                         const RasterCheck& check = {});

/// Writes a GeoTIFF with units and reference system, heights in its own unit; or for any other name an ESRI ASCII grid,
/// heights in the unit of lengths, and its reference system, where it has one, into a .prj file beside it. What stood
/// there is replaced when all is written. Throws base::InputError.
void writeRaster(const EsriGrid& grid, const std::filesystem::path& file);

}  // namespace scene
