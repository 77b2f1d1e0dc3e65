// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render_node/gl/solid_mesh.hpp"
#include "render_node/surface/frustum.hpp"
#include "sand/model/tool_shape.hpp"

namespace render_node {

/// Triangles of a sphere of radius 1 around the origin: an icosahedron, each face split into four, `splits` times.
[[nodiscard]] std::vector<SolidVertex> makeSphere(int splits);
/// Any tool, as it is turned now, around its centre; its radius is 1. Flat ones and soles are plates on a handle.
[[nodiscard]] std::vector<SolidVertex> makeTool(const sand::ToolShape& shape, const sand::Heading& heading);
/// The same within this.
[[nodiscard]] Box boxOfTool(const sand::ToolShape& shape);

/// The tool of radius 1: the shader moves and scales it.
class ToolMesh {
public:
    /// A tool of another radius alone costs nothing.
    void show(const sand::ToolShape& shape, const sand::Heading& heading);
    /// After show().
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
