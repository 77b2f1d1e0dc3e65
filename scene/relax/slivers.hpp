// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sand/tin/geometry/triangles.hpp"

namespace scene::relax {

inline constexpr std::int32_t kNearRim = 256;        // [lattice step]
inline constexpr std::int32_t kStripsAcross = 1024;  // least number of strips of that width on the field's shorter side
inline constexpr std::int64_t kFlat = 64;            // ratio of a triangle's longest edge to its height

/// Returns the slots of the slivers along the sides of a field, each once.
///
/// A survey's points along a straight rim lie a few lattice steps off the rim and off each other. The triangles between
/// them and the field's side are very flat. Sand on them does not slide as elsewhere, and does not come to rest. Such
/// a triangle has its longest edge at the boundary. All its corners are within kNearRim steps of one side, and it is
/// flatter than 1 : kFlat. The triangle beyond a sliver is then at the boundary, and is inspected too.
[[nodiscard]] std::vector<std::int32_t> sliversAtRim(const sand::tin::Triangles& mesh);

/// Lattice whose places are exact as doubles. The areas of triangles over these places are exact, too.
struct ExactLattice {
    double west = 0, south = 0, step = 1;
    [[nodiscard]] std::array<double, 2> at(const sand::tin::LatticePoint& place) const {
        return {west + place.x * step, south + place.y * step};
    }
};

/// Moves points back onto the lattice if a triangle on ground would otherwise not be counter-clockwise, or so flat that
/// rounding turns it. `points` has one point per vertex, each within half a step of its place. Returns the number of
/// moved points.
int keepCounterClockwise(const sand::tin::Triangles& mesh, const ExactLattice& lattice,
                         std::vector<std::array<double, 3>>& points);

}  // namespace scene::relax
