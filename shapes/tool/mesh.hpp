// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/model/box.hpp"
#include "shapes/model/solid_vertex.hpp"
#include "shapes/tool/drawn_tool.hpp"

namespace shapes {

/// Returns the triangles of a sphere of radius 1 around the origin. They come from an icosahedron: each triangle is
/// split into four, `splits` times.
[[nodiscard]] std::vector<SolidVertex> makeSphere(int splits);
/// Returns the triangles of a tool around its centre, scaled to radius 1. Flat tools and soles are plates
/// on a handle.
[[nodiscard]] std::vector<SolidVertex> makeTool(const sand::Tool& tool);
/// Returns a box around makeTool() for any heading.
[[nodiscard]] Box boxOfTool(const sand::Tool& tool);
/// Returns a box around a tool at its place [scene unit].
[[nodiscard]] Box bodyOf(const DrawnTool& drawn);

/// The values on which makeTool() depends. The radius alone changes no triangle.
struct ToolForm {
    sand::ToolKind kind;
    double width;  // [radius]
    sand::Heading heading;
    friend bool operator==(const ToolForm&, const ToolForm&) = default;
};
[[nodiscard]] ToolForm formOf(const sand::Tool& tool);

}  // namespace shapes
