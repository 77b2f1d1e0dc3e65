// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "sand/replica.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/model/scene.hpp"

namespace scene {

/// Calls `write` with the sand of a replica as a height field, and with the scene that it began as. Rasters and
/// earthwork need this form. The sand of a TIN is sampled at the middles of nominal cells; its holes are then walls of
/// that scene's ground.
void withCells(const sand::Replica& replica, const Scene& scene,
               const std::function<void(const sand::HeightField&, const Scene&)>& write);

/// Returns the sand's triangles in the units of the scene's source: those between the cells of a height field, or those
/// of a TIN.
[[nodiscard]] Mesh meshOf(const sand::Replica& replica, const Scene& scene);

}  // namespace scene
