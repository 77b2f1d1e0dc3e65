// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "scene/import/esri_grid.hpp"

namespace scene {

/// Returns why the lengths of a grid without a coordinate system seem to be degrees, with the command that makes metres
/// of them. Returns nullopt if they can be lengths, or if the grid has a coordinate system.
///
/// Lengths seem to be degrees if all coordinates can be a longitude and a latitude, and the median slope would be
/// steeper than 80 degrees. No sand and hardly any terrain is so steep.
[[nodiscard]] std::optional<std::string> whyDegrees(const EsriGrid& grid);

}  // namespace scene
