// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "sand/model/tool_shape.hpp"

namespace render_node {

/// Ellipsoid that replaces a tool when light is computed: the tool itself, or an ellipsoid around its plate.
struct ToolLight {
    glm::dvec3 centre;       // [scene unit]
    double radius = 0;       // [scene unit], longest half axis
    glm::dmat3 toBall{1.0};  // from the scene to a space in which the ellipsoid has radius 1

    /// Makes the ellipsoid of a tool whose centre is at `place`.
    ToolLight(const sand::ToolShape& shape, const sand::Heading& heading, const glm::dvec3& place, double toolRadius);
};

}  // namespace render_node
