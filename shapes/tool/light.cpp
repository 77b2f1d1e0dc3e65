// SPDX-License-Identifier: Apache-2.0
#include "shapes/tool/light.hpp"

#include <algorithm>

namespace shapes {

ToolLight::ToolLight(const DrawnTool& drawn) : centre(drawn.place), radius(drawn.radius) {
    using enum sand::ToolKind;
    const sand::Tool& tool = drawn.tool;
    const double toolRadius = radius;
    if (tool.kind == sphere) {
        toBall = glm::dmat3(1 / toolRadius);
        return;
    }
    const double width = sand::isRound(tool.kind) ? 1.0 : std::max(0.02, double(tool.halfWidth) / tool.radius);
    glm::dvec3 half(1, width, 1);
    if (tool.kind != ellipsoid) {
        half.z = 0.3;  // for a plate whose thickness is a quarter of the radius
        centre.z -= (1 - 0.125) * toolRadius;
    }
    if (tool.kind == rectangle) {
        half *= glm::dvec3(1.12, 1.12, 1);  // an ellipse between the rectangle's sides and its corners
    }
    radius = toolRadius * std::max(half.x, half.z);
    const glm::dvec2 along = glm::normalize(glm::dvec2(tool.heading.x, tool.heading.y));
    const glm::dmat3 turned(glm::dvec3(along, 0), glm::dvec3(-along.y, along.x, 0), glm::dvec3(0, 0, 1));
    const glm::dvec3 axis = 1.0 / (toolRadius * half);
    toBall = glm::dmat3(glm::dvec3(axis.x, 0, 0), glm::dvec3(0, axis.y, 0), glm::dvec3(0, 0, axis.z)) *
             glm::transpose(turned);
}

ToolUniforms uniformsOf(const DrawnTool& drawn, const glm::vec3& sun) {
    if (drawn.isBall()) {
        return {.tool = glm::vec4(drawn.place, 1 / drawn.radius)};
    }
    const ToolLight light(drawn);
    const glm::dvec3 turned = light.toBall * glm::dvec3(sun);
    return {.tool = glm::vec4(glm::vec3(light.centre), 1),
            .space = glm::mat3(light.toBall),
            .sun = glm::vec3(glm::normalize(turned)),
            .sunStep = static_cast<float>(1 / (glm::length(turned) * light.radius))};
}

}  // namespace shapes
