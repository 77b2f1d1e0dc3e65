// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "scene/import/importer.hpp"

namespace scene {

/// Does the work of Importer::geoTiff().
[[nodiscard]] base::Bytes geoTiffOf(const EsriGrid& grid, const std::string& file);

}  // namespace scene
