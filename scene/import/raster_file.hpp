// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/import/esri_grid.hpp"

namespace scene {

class Importer;

/// Returns whether the name is that of a GeoTIFF: it ends in .tif or .tiff.
[[nodiscard]] bool namesGeoTiff(const std::filesystem::path& file);

/// Throws base::InputError for a name whose ending stands for another format. Call it before long work. Names without
/// an ending, names in .txt, and files that are not regular files are ESRI ASCII grids, as for readRaster().
void checkRasterName(const std::filesystem::path& file);

/// Reads heights in any format. readEsriGrid() reads a file if it holds an ESRI ASCII grid, or if it is not a regular
/// file. It also reads a file if its name ends in .asc or .txt, or has no ending. Importer::readDem() reads all other
/// files.
///
/// A text file loads GDAL only if a .prj file is beside it. The grid then has units, and degrees are refused. `check`
/// may be empty. Throws base::InputError.
[[nodiscard]] EsriGrid readRaster(const std::filesystem::path& file, const RasterCheck& check = {});

/// Reads a raster by Importer::readDem(), and adds warnings about its heights. Throws base::InputError.
[[nodiscard]] EsriGrid readByGdal(const std::filesystem::path& file, const Importer& importer,
                                  const RasterCheck& check = {});

/// Reads an ESRI ASCII grid with the units that `importer` finds in it and beside it. Throws base::InputError.
[[nodiscard]] EsriGrid readTextWithUnits(const std::filesystem::path& file, const Importer& importer,
                                         const RasterCheck& check = {});

/// Writes a raster in the format that its name stands for. A GeoTIFF gets units, reference system, and heights in its
/// own unit. Any other name gets an ESRI ASCII grid with heights in the unit of lengths. If such a grid has a
/// reference system, it goes into a .prj file beside the grid. An existing file is replaced when everything is written.
/// Throws base::InputError.
void writeRaster(const EsriGrid& grid, const std::filesystem::path& file);

}  // namespace scene
