// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

namespace shapes {

/// Vertex of a solid body: anything except the sand's surface. Input of solid.vert.glsl.
struct SolidVertex {
    glm::vec3 position;  // in the model's unit
    glm::vec3 normal;
    glm::vec2 along;  // place along and across the grain of wood, in the model's unit
};

}  // namespace shapes
