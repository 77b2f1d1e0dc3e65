// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "render_node/tool/drawn_tool.hpp"

namespace render_node {

/// Ellipsoid that replaces a tool when light is computed: the tool itself, or an ellipsoid around its plate.
struct ToolLight {
    glm::dvec3 centre;       // [scene unit]
    double radius = 0;       // [scene unit], longest half axis
    glm::dmat3 toBall{1.0};  // from the scene to a space in which the ellipsoid has radius 1

    explicit ToolLight(const DrawnTool& drawn);
};

}  // namespace render_node
