// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/import/esri_grid.hpp"

namespace scene {

/// Reads an ESRI ASCII grid piece by piece, as readEsriText() does. The units of a .prj file are left to
/// readTextWithUnits(), but degrees are refused.
[[nodiscard]] EsriGrid readEsriGrid(const std::filesystem::path& file, const RasterCheck& check = {});
/// Returns whether a regular file is an ESRI ASCII grid by its first word, which must be a key of the header.
[[nodiscard]] bool holdsEsriGrid(const std::filesystem::path& file);

/// Writes the shortest decimals from which the same numbers are read again. An existing `file` is replaced when
/// everything is written. Throws base::InputError if the file cannot be written completely.
void writeEsriGrid(const EsriGrid& grid, const std::filesystem::path& file);

}  // namespace scene
