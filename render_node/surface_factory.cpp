// SPDX-License-Identifier: Apache-2.0
#include "render_node/surface_factory.hpp"

#include "render_node/grid/mesh.hpp"
#include "render_node/tin/mesh.hpp"

namespace render_node {

std::unique_ptr<DrawnSurface> makeDrawnSurface(const sand::SurfaceData& data, double cellSize, const glm::vec3& sun,
                                               int stepsPerSecond) {
    if (const auto* tin = std::get_if<sand::TinData>(&data)) {
        return std::make_unique<TinMesh>(tin->view, cellSize);
    }
    return std::make_unique<GridMesh>(std::get<sand::GridData>(data), sun, stepsPerSecond);
}

}  // namespace render_node
