// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/import/esri_grid.hpp"
#include "scene/import/points_file.hpp"
#include "scene/model/raster_statement.hpp"

namespace scene {

/// Returns what a raster's header and the files beside it say about its numbers.
[[nodiscard]] RasterStatement statementOf(const EsriGrid& grid);
/// Points have no unit: their lengths and heights are the same.
[[nodiscard]] RasterStatement statementOf(const Points& points, const std::string& file);

/// Returns the name of a unit by its size: "metres" for 1, "units of unknown length" for 0.
[[nodiscard]] std::string unitName(double metres);

/// Throws base::InputError unless the rock's lengths and heights are in the units of the sand. Units that nothing
/// declares are those of the other file, unless that one has heights in another unit than lengths.
void requireSameUnits(const EsriGrid& sand, const EsriGrid& rock);
/// Does the same for sand whose units are known without its raster. `file` is the sand's.
void requireSameUnits(const RasterUnits& sand, const std::string& file, const EsriGrid& rock);

}  // namespace scene
