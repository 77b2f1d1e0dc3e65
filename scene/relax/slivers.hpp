// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sand/tin/geometry/triangles.hpp"

namespace scene::relax {

inline constexpr std::int32_t kNearRim = 256;        // [lattice step]
inline constexpr std::int32_t kStripsAcross = 1024;  // at least, of that width, on the field's shorter side
inline constexpr std::int64_t kFlat = 64;            // longest edge over height

/// Finds slivers along the sides of a field: slots, each once.
///
/// A survey's points along a straight rim lie a few lattice steps off it, and off one another. The triangles between
/// them and the field's side are so flat that sand on them neither slides as elsewhere nor comes to rest. Such a
/// triangle has its longest edge at the boundary and all corners within kNearRim steps of one side, and is flatter than
/// 1 : kFlat. A triangle beyond one is then at the boundary, and is looked at in turn.
[[nodiscard]] std::vector<std::int32_t> sliversAtRim(const sand::tin::Triangles& mesh);

/// A lattice whose places are doubles without any rounding, and so are the areas of triangles over them.
struct ExactLattice {
    double west = 0, south = 0, step = 1;
    [[nodiscard]] std::array<double, 2> at(const sand::tin::Place& place) const {
        return {west + place.x * step, south + place.y * step};
    }
};

/// Puts points back onto the lattice where a triangle on ground would not be counter-clockwise between them, or so flat
/// that a rounding turns it. `points` by vertex, each within half a step of its place. Returns how many it moved.
int keepCounterClockwise(const sand::tin::Triangles& mesh, const ExactLattice& lattice,
                         std::vector<std::array<double, 3>>& points);

}  // namespace scene::relax
