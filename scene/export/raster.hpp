// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene/import/esri_grid.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/model/scene.hpp"

namespace scene {

/// Returns `field` in the place from which the scene's terrain came. Corner, lengths and heights are those of the
/// source. Walls have no data. The functions below and this one throw std::invalid_argument unless `field` has the
/// scene's cells.
[[nodiscard]] EsriGrid heightsOf(const sand::HeightField& field, const Scene& scene);

/// Returns how much higher `field` is than the start of the scene, in the source's unit.
[[nodiscard]] EsriGrid differenceOf(const sand::HeightField& field, const Scene& scene);

/// Returns triangles between the middles of neighbouring cells that are not walls, in the source's units. Their
/// diagonals run to the north-east.
[[nodiscard]] Mesh meshOf(const sand::HeightField& field, const Scene& scene);

/// Sand that was taken away and put down since the start of the scene.
struct Earthwork {
    std::int64_t cut = 0, fill = 0;  // [unit · cell], exact, at least 0
    double unit = 0;                 // size of a unit · cell [cubic scene unit]
    double cubicMetres = 0;          // size of a unit · cell [m³]; 0 if the length of the scene's units is unknown
};
[[nodiscard]] Earthwork earthworkOf(const sand::HeightField& field, const Scene& scene);

}  // namespace scene
