// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/toml_table.hpp"
#include "scene/georeference.hpp"
#include "scene/import/esri_grid.hpp"
#include "scene/import/points_file.hpp"
#include "scene/load/scene_file.hpp"

namespace scene {

/// Heights from outside, as a scene names them: on a raster, or at points.
struct TerrainSource {
    EsriGrid raster{};                    // cells, corner and heights in scene units, the datum not yet taken off
    Points points{};                      // in scene units, likewise; empty where there is a raster
    Georeference georeference{};          // but for the corner: referenceAt()
    std::vector<std::string> warnings{};  // one line each

    /// The georeference of a field whose south-west corner is that of `part`, a part of the raster.
    [[nodiscard]] Georeference referenceAt(const EsriGrid& part) const;
};

/// The kinds of [terrain] that readSource() reads.
[[nodiscard]] const std::vector<std::string_view>& sourceKinds();

/// Reads the keys of one of sourceKinds() in [terrain], and of [field] for a function, which says how many cells there
/// are. `kind` is its index. Calls `check` with the size of a raster, or of a function's field, before its heights are
/// read or computed. Throws base::InputError with file, line and key; what is wrong in another file names that. Loads
/// GDAL or muParser where the kind needs them.
[[nodiscard]] TerrainSource readSource(const host::TomlTable& file, const host::TomlTable& terrain, int kind,
                                       const RasterCheck& check);

}  // namespace scene
