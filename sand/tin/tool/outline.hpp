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

/// A tool as control points and edges between them (second paper), for a mesh to take in.
///
/// Ellipses have 32 points, rectangles 8 a side, the sole of a foot the outline of its pieces' union; what is too small
/// for that has fewer, and a tool of a tenth of a cell none. Inside lie rings of points where the underside is curved:
/// they end no edge. Every point is below the tool as TurnedShape tells it: two probe units within the outline.
struct Outline {
    std::vector<Place> points;               // offsets from the tool's centre [probe unit], no two alike
    std::vector<std::pair<int, int>> edges;  // of points, by index

    /// A function of the two alone, in whole numbers and IEEE sums, products and quotients. A tool that is turned by a
    /// right angle has its points turned.
    static Outline of(const ToolShape& shape, const Heading& heading);
};

/// An outline where it stands: what lies in the field of it. An edge across the rim ends there. Points in a hole, and
/// edges that come near one, are left out: no constraint crosses a hole's outline.
struct PlacedOutline {
    std::vector<Place> points;                   // in the mesh's coordinates, no two alike
    std::vector<std::pair<Place, Place>> edges;  // none along the rim
};
[[nodiscard]] PlacedOutline placed(const Outline& outline, std::int32_t x, std::int32_t y,
                                   const Triangles& field /* its size is looked at, nothing else */,
                                   const Holes* holes = nullptr);

}  // namespace sand::tin
