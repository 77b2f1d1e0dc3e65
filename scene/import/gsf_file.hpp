// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/import/esri_grid.hpp"

namespace scene {

/// Reads a Gwyddion Simple Field 1.0: a scan with heights in metres and lengths in metres. NaN means no data.
///
/// The format follows the description in Gwyddion's user guide. Lines of "Name = value" are followed by zeros up to a
/// multiple of four bytes, then by little-endian floats from the north-west. `check` may be empty. Throws
/// base::InputError with file and line, or pixel, for: an invalid header, missing or additional numbers, infinite
/// heights, and values that are not in metres.
[[nodiscard]] EsriGrid readGsf(const std::filesystem::path& file, const RasterCheck& check = {});

}  // namespace scene
