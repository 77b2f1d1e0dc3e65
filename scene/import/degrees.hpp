// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/import/esri_grid.hpp"

namespace scene {

/// Throws base::InputError if the lengths of a grid without a coordinate system seem to be degrees. The line has the
/// command that makes metres of them, and then `otherwise`, which says how to insist on lengths.
///
/// Lengths seem to be degrees if all coordinates can be a longitude and a latitude, and the median slope would be
/// steeper than 80 degrees. Longitudes may count from -180 or from 0. No sand and hardly any terrain is so steep. The
/// grid may reach half a cell beyond the date line and the poles.
void requireLengths(const EsriGrid& grid, const std::string& otherwise);

}  // namespace scene
