// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "sand/tin/geometry/tin_start.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// The sand that a start describes.
[[nodiscard]] VertexSand layerOf(const TinStart& start);

/// A start, and how far it is from the heights that it was made of.
struct Followed {
    TinStart start;
    double maxError = 0;  // [unit], vertical, over the middles of all cells on ground
};

/// Makes the TIN of a field: the field's corners, its border, the middles of cells at settings.widest, and the points
/// that greedy insertion adds to these.
///
/// It ends when the surface is as near to every cell's middle, and to those of the rim, as settings.maxError, or when
/// there are settings.mostVertices. An open rim has vertices at most settings.widest apart, or 16 cells where that is
/// 0. Walls, which may be null, are holes. Throws std::length_error when the border needs more vertices than there may
/// be.
[[nodiscard]] Followed follow(const HeightField& field, const Ground* walls, const Settings& settings,
                              Rim rim = Rim::closed);
/// The TIN of given places and heights; the corners of the field are added where they are missing, as high as the
/// nearest place. start.places need not begin with them, and constraints are by place. An open rim gets vertices as
/// follow() has them, on the straight lines between those that are there.
[[nodiscard]] TinStart join(const TinStart& start, Rim rim = Rim::closed);
/// The TIN of a surface as it is now, for a scene that starts at rest.
/// Heights are rounded to whole units; settings are those of the surface's own start.
[[nodiscard]] TinStart startOf(const VertexSand& layer, const Settings& settings);

}  // namespace sand::tin
