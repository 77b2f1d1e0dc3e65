// SPDX-License-Identifier: Apache-2.0
#include "scene/export/results.hpp"

#include "scene/export/raster.hpp"
#include "scene/export/tin_raster.hpp"

namespace scene {

void withCells(const sand::Replica& replica, const Scene& scene,
               const std::function<void(const sand::HeightField&, const Scene&)>& write) {
    const sand::SurfaceData data = replica.surface().data();
    if (const auto* grid = std::get_if<sand::GridData>(&data)) {
        write(grid->field, scene);
    } else {
        write(sampled(replica, scene.tin->holes.get()), sampledScene(scene));
    }
}

Mesh meshOf(const sand::Replica& replica, const Scene& scene) {
    const sand::SurfaceData data = replica.surface().data();
    if (const auto* grid = std::get_if<sand::GridData>(&data)) {
        return meshOf(grid->field, scene);
    }
    return meshOf(std::get<sand::TinData>(data).view, scene);
}

}  // namespace scene
