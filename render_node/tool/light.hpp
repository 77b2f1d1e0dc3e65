// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "sand/model/tool_shape.hpp"

namespace render_node {

/// The ellipsoid that a tool is to the light: itself, or around its plate.
struct ToolLight {
    glm::dvec3 centre;       // [scene unit]
    double radius = 0;       // [scene unit], its longest half axis
    glm::dmat3 toBall{1.0};  // from the scene to where its radius is 1

    /// Of a tool with its centre there.
    ToolLight(const sand::ToolShape& shape, const sand::Heading& heading, const glm::dvec3& place, double toolRadius);
};

}  // namespace render_node
