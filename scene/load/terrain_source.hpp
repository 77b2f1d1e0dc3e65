// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/toml_table.hpp"
#include "scene/import/esri_grid.hpp"
#include "scene/import/points_file.hpp"
#include "scene/load/scene_file.hpp"
#include "scene/model/georeference.hpp"
#include "scene/model/raster_statement.hpp"

namespace scene {

/// Heights from another file or a function, as a scene names them: a raster, or points.
struct TerrainSource {
    EsriGrid raster{};            // cells, corner and heights in scene units, before the datum is subtracted
    Points points{};              // in scene units, before the datum is subtracted; empty for a raster
    Georeference georeference{};  // without the corner, which referenceAt() sets
    std::optional<RasterStatement> statement{};  // nullopt unless the heights are from a file
    bool onMap = false;                   // cells and corner are those of a map, so that the lengths may be degrees
    std::vector<std::string> warnings{};  // one line each

    /// Returns the georeference of a field whose south-west corner is that of `part`, a part of the raster.
    [[nodiscard]] Georeference referenceAt(const EsriGrid& part) const;
};

/// Returns the kinds of [terrain] that readSource() reads.
[[nodiscard]] const std::vector<std::string_view>& sourceKinds();

/// Reads the keys of one of sourceKinds() in [terrain]; `kind` is its index. For a function, also reads the number of
/// cells from [field]. Calls `check` with the size of a raster, or of a function's field, before its heights are read
/// or computed, and check.read() meanwhile. Loads GDAL or muParser if the kind needs them. Throws base::InputError with
/// file, line and key. An error in another file names that file.
[[nodiscard]] TerrainSource readSource(const host::TomlTable& file, const host::TomlTable& terrain, int kind,
                                       const RasterCheck& check);

}  // namespace scene
