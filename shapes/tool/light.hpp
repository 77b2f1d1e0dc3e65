// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "shapes/tool/drawn_tool.hpp"

namespace shapes {

/// Ellipsoid that replaces a tool when light is computed: the tool itself, or an ellipsoid around its plate.
struct ToolLight {
    glm::dvec3 centre;       // [scene unit]
    double radius = 0;       // [scene unit], longest half axis
    glm::dmat3 toBall{1.0};  // from the scene to a space in which the ellipsoid has radius 1

    explicit ToolLight(const DrawnTool& drawn);
};

/// Values of the uniforms by which the shaders take light away under a tool.
struct ToolUniforms {
    glm::vec4 tool{0, 0, 1e9, 1};  // uTool; at first too far away to take any light
    // Only stamp.glsl has these:
    glm::mat3 space{1};  // uToolSpace
    glm::vec3 sun{0};    // uToolSun
    float sunStep = 1;   // uToolStep
};
/// Returns them for a tool with a radius. `sun` points towards the sun and has length 1.
[[nodiscard]] ToolUniforms uniformsOf(const DrawnTool& drawn, const glm::vec3& sun);

}  // namespace shapes
