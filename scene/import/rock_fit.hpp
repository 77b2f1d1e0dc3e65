// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/import/esri_grid.hpp"

namespace scene {

/// Returns a grid without its heights: its file, cells, place and units.
[[nodiscard]] EsriGrid withoutHeights(const EsriGrid& grid);

/// Throws base::InputError, which names both files, unless rock has the cells of the sand on it: their number, sides
/// and place. Reads no heights.
void requireSameCells(const EsriGrid& sand, const EsriGrid& rock);

/// Throws base::InputError, which names both files and systems, if two rasters declare different coordinate systems.
/// Vertical datums do not count. Loads GDAL if the texts of the systems differ.
void requireSameSystem(const EsriGrid& sand, const EsriGrid& rock);

/// Makes all checks of rock against the sand on it: units, coordinate system and cells.
void requireFit(const EsriGrid& sand, const EsriGrid& rock);

}  // namespace scene
