// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render_node/gl/solid_mesh.hpp"
#include "shapes/tool/mesh.hpp"

namespace render_node {

/// Tool of radius 1 in GL. The shader moves and scales it.
class ToolMesh {
public:
    /// Makes the triangles for this tool if they differ from the last ones. A change of the radius alone costs no time.
    void show(const sand::Tool& tool);
    /// Draws the tool. Must be called after show().
    void draw() const { mesh_.draw(); }

private:
    std::optional<shapes::ToolForm> shown_;
    SolidMesh mesh_;
};

}  // namespace render_node
