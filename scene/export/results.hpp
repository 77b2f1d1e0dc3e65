// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "sand/replica.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/scene.hpp"

namespace scene {

/// Calls `write` with the sand of a replica by cells, and with the scene that it began as: for rasters and earthwork.
/// Samples both at the middles of nominal cells if the sand is a TIN; holes are then walls of that scene's ground.
void withCells(const sand::Replica& terrain, const Scene& scene,
               const std::function<void(const sand::HeightField&, const Scene&)>& write);

/// The sand's triangles in the units of the scene's source: between the cells of a height field, or a TIN's own.
[[nodiscard]] Mesh meshOf(const sand::Replica& terrain, const Scene& scene);

}  // namespace scene
