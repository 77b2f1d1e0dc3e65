// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "scene/import/esri_grid.hpp"

namespace scene {

/// Fills a field with the heights of a raster that has as many cells. Cells without data become walls. They are felt as
/// flats at the lowest height of the terrain.
///
/// @param unitsOf  Returns a height of the raster in the field's units. It may throw.
/// @param ground   Gets the walls. It is created if it is null and there are walls.
/// @param laid     Called with the part of the rows that is filled, 0 to 1. It may be empty.
void layTerrain(const EsriGrid& grid, const std::function<std::int32_t(double height)>& unitsOf,
                sand::HeightField& field, std::shared_ptr<sand::Ground>& ground,
                const std::function<void(double share)>& laid = {});

}  // namespace scene
