// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/replica.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/model/scene.hpp"

namespace scene {

/// Returns a TIN's surface at the middles of its nominal cells, rounded to whole units. Heights in `holes` are 0.
/// `holes` may be null.
[[nodiscard]] sand::HeightField sampled(const sand::Replica& replica, const sand::tin::Holes* holes);

/// Returns the scene of a TIN with its first heights as a field of nominal cells, for comparisons of rasters. Holes are
/// walls of its ground.
[[nodiscard]] Scene sampledScene(const Scene& scene);

/// Returns the triangles of a TIN, without its holes, in the units of the scene's source.
[[nodiscard]] Mesh meshOf(const sand::tin::SurfaceView& tin, const Scene& scene);

}  // namespace scene
