// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/replica.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/scene.hpp"

namespace scene {

/// A TIN's surface at the middles of its nominal cells, rounded to whole units; 0 in its holes, which may be null.
[[nodiscard]] sand::HeightField sampled(const sand::Replica& terrain, const sand::tin::Holes* holes);

/// The scene of a TIN with the heights it starts with as a field of nominal cells, for whoever compares rasters: holes
/// are walls of its ground.
[[nodiscard]] Scene sampledScene(const Scene& scene);

/// A TIN's own triangles, without its holes, in the units of the scene's source.
[[nodiscard]] Mesh meshOf(const sand::tin::SurfaceView& tin, const Scene& scene);

}  // namespace scene
