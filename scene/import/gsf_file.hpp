// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/import/esri_grid.hpp"

namespace scene {

/// Reads a Gwyddion Simple Field 1.0: a scan of heights in metres, lengths in metres. Not a number is no data.
///
/// After the format's description in Gwyddion's user guide: lines of "Name = value", zeros up to a multiple of four
/// bytes, then little-endian floats from the north-west. `check` may be empty. Throws base::InputError with file and
/// line, or pixel: a header that is none, numbers missing or too many, infinite heights, values that are not metres.
[[nodiscard]] EsriGrid readGsf(const std::filesystem::path& file, const RasterCheck& check = {});

}  // namespace scene
