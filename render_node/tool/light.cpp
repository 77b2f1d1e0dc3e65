// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool/light.hpp"

#include <algorithm>

namespace render_node {

ToolLight::ToolLight(const sand::ToolShape& shape, const sand::Heading& heading, const glm::dvec3& place,
                     double toolRadius)
    : centre(place), radius(toolRadius) {
    using enum sand::ToolKind;
    if (shape.kind == sphere) {
        toBall = glm::dmat3(1 / toolRadius);
        return;
    }
    const double width = sand::isRound(shape.kind) ? 1.0 : std::max(0.02, double(shape.halfWidth) / shape.radius);
    glm::dvec3 half(1, width, 1);
    if (shape.kind != ellipsoid) {
        half.z = 0.3;  // for a plate whose thickness is a quarter of the radius
        centre.z -= (1 - 0.125) * toolRadius;
    }
    if (shape.kind == rectangle) {
        half *= glm::dvec3(1.12, 1.12, 1);  // an ellipse between the rectangle's sides and its corners
    }
    radius = toolRadius * std::max(half.x, half.z);
    const glm::dvec2 along = glm::normalize(glm::dvec2(heading.x, heading.y));
    const glm::dmat3 turned(glm::dvec3(along, 0), glm::dvec3(-along.y, along.x, 0), glm::dvec3(0, 0, 1));
    const glm::dvec3 axis = 1.0 / (toolRadius * half);
    toBall = glm::dmat3(glm::dvec3(axis.x, 0, 0), glm::dvec3(0, axis.y, 0), glm::dvec3(0, 0, axis.z)) *
             glm::transpose(turned);
}

}  // namespace render_node
