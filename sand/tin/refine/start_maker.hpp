// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/tin/geometry/tin_start.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// The sand that a start describes.
[[nodiscard]] VertexSand layerOf(const TinStart& start);

/// The TIN with the fewest points that greedy insertion needs to come as near to every cell's middle, and to those of
/// the rim, as settings.maxError, or that settings.mostVertices allows beside those at settings.widest. Walls, which
/// may be null, are holes: throws std::length_error when what their outline needs is more.
[[nodiscard]] TinStart follow(const HeightField& field, const Ground* walls, const Settings& settings);
/// The TIN of given places and heights; the corners of the field are added where they are missing, as high as the
/// nearest place. start.places need not begin with them, and constraints are by place.
[[nodiscard]] TinStart join(const TinStart& start);
/// The TIN of a surface as it is now, for a scene that starts at rest.
/// Heights are rounded to whole units; settings are those of the surface's own start.
[[nodiscard]] TinStart startOf(const VertexSand& layer, const Settings& settings);

}  // namespace sand::tin
