// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/import/importer.hpp"

namespace sand {

/// Importer::geoTiff().
[[nodiscard]] base::Bytes geoTiffOf(const EsriGrid& grid, const std::string& file);

}  // namespace sand
