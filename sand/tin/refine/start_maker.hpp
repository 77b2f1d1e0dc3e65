// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "sand/tin/geometry/tin_start.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// Returns the sand that a start describes. Throws base::FormatError if the outline of its holes is incomplete.
[[nodiscard]] VertexSand layerOf(const TinStart& start);

/// A start, and its error against the heights that it was made from.
struct Followed {
    TinStart start;
    double maxError = 0;  // largest vertical error at the centres of cells on ground [unit]
};

/// Makes the TIN of a field. Its vertices are the field's corners, its border, the cell centres at distance
/// settings.widest, and the points that greedy insertion adds to these.
///
/// Stops when the surface is within settings.maxError of every cell's centre, and of the rim beside every centre. Also
/// stops at settings.mostVertices. On the rim, vertices are at most settings.widest apart, or 16 cells if that is 0. A
/// closed rim has fewer if there is no room for them. `walls` may be null; wall cells become holes. Throws
/// std::length_error if the border needs more vertices than allowed. `done` is called with the part of the work that is
/// done, 0 to 1. It may be empty.
[[nodiscard]] Followed follow(const HeightField& field, const Ground* walls, const Settings& settings,
                              Rim rim = Rim::closed, const std::function<void(double share)>& done = {});
/// Returns the TIN of the places and heights of `start`. Adds the missing corners of the field, each as high as the
/// nearest place. start.places need not begin with the corners, and start.constraints refer to start.places. The rim
/// gets vertices as with follow(), on the straight lines between existing vertices. Calls `done` as follow() does.
[[nodiscard]] TinStart join(const TinStart& start, Rim rim = Rim::closed,
                            const std::function<void(double share)>& done = {});
/// Returns the TIN of the current surface. A scene that starts at rest uses it. Rounds heights to whole units.
/// `settings` are those of the start from which the surface began.
[[nodiscard]] TinStart startOf(const VertexSand& layer, const Settings& settings);

}  // namespace sand::tin
