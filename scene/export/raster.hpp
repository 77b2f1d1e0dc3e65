// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene/import/esri_grid.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/scene.hpp"

namespace scene {

/// A scene's field where its terrain came from: corner, lengths and heights of the source, walls without data. All
/// throw std::invalid_argument unless `field` has the scene's cells.
[[nodiscard]] EsriGrid heightsOf(const sand::HeightField& field, const Scene& scene);

/// How much higher `field` is than the scene began, in the source's unit.
[[nodiscard]] EsriGrid differenceOf(const sand::HeightField& field, const Scene& scene);

/// Triangles between neighbouring middles of cells that are no walls, their diagonals to the north-east, in the
/// source's units.
[[nodiscard]] Mesh meshOf(const sand::HeightField& field, const Scene& scene);

/// What was taken away and what was put down since the scene began.
struct Earthwork {
    std::int64_t cut = 0, fill = 0;  // [unit · cell], exact, neither below 0
    double unit = 0;                 // [cubic scene unit] of one of them
    double cubicMetres = 0;          // [m³] of one of them; 0: nobody said how long the scene's units are
};
[[nodiscard]] Earthwork earthworkOf(const sand::HeightField& field, const Scene& scene);

}  // namespace scene
