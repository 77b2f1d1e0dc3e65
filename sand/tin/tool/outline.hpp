// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sand/model/heading.hpp"
#include "sand/model/tool_shape.hpp"
#include "sand/tin/geometry/holes.hpp"
#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// A tool as control points and edges between them (Purchart et al. 2012), for insertion into a mesh.
///
/// An ellipse has 32 points, a rectangle has 8 per side, and a footprint has the outline of the union of its pieces. A
/// smaller tool has fewer points, and a tool of a tenth of a cell has no points. If the underside is curved, rings of
/// points without edges lie inside. Every point is below the tool as defined by TurnedShape, two probe units within
/// the outline.
struct Outline {
    std::vector<LatticePoint> points;        // offsets from the tool's centre [probe unit], all different
    std::vector<std::pair<int, int>> edges;  // indices of points

    /// Returns the outline of a tool. It depends only on the arguments, and uses only whole numbers and IEEE
    /// operations. If the tool turns by a right angle, the points turn with it.
    static Outline of(const Tool& tool);
};

/// The part of an outline that lies on ground, at a position of the tool. An edge across the rim or the border of a
/// hole ends there. Edges near a place where two cells without ground touch at a corner are left out. So no constraint
/// crosses a hole's outline.
struct PlacedOutline {
    std::vector<LatticePoint> points;                          // in the mesh's coordinates, all different
    std::vector<std::pair<LatticePoint, LatticePoint>> edges;  // no edge runs along the rim
};
/// Returns the outline of a tool whose centre is at (x, y) [probe unit].
[[nodiscard]] PlacedOutline placed(const Outline& outline, std::int32_t x, std::int32_t y,
                                   const Triangles& field /* only its size is used */, const Holes* holes = nullptr);

}  // namespace sand::tin
