// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render_node/gl/solid_mesh.hpp"
#include "render_node/surface/frustum.hpp"
#include "render_node/tool/drawn_tool.hpp"

namespace render_node {

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

/// Tool of radius 1 in GL. The shader moves and scales it.
class ToolMesh {
public:
    /// Makes the triangles for this tool if they differ from the last ones. A change of the radius alone costs no time.
    void show(const sand::Tool& tool);
    /// Draws the tool. Must be called after show().
    void draw() const { mesh_.draw(); }

private:
    struct Shown {
        sand::ToolKind kind;
        double width;  // [radius]
        sand::Heading heading;
        friend bool operator==(const Shown&, const Shown&) = default;
    };
    std::optional<Shown> shown_;
    SolidMesh mesh_;
};

}  // namespace render_node
