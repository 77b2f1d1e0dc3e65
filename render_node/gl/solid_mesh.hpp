// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// Vertex of a solid body: anything except the sand's surface. Input of solid.vert.glsl.
struct SolidVertex {
    glm::vec3 position;  // in the model's unit
    glm::vec3 normal;
    glm::vec2 along;  // place along and across the grain of wood, in the model's unit
};

/// Triangles in GL, counter-clockwise seen from outside. Used by one thread, with its context current.
class SolidMesh {
public:
    SolidMesh();
    /// Replaces the triangles. Each triangle has three vertices.
    void set(const std::vector<SolidVertex>& triangles);
    /// Draws all triangles. The program must be in use.
    void draw() const { draw(0, count_); }
    /// Draws some of the triangles. The program must be in use.
    void draw(GLint firstVertex, GLsizei vertices) const;

private:
    GlVertexArray array_;
    GlBuffer buffer_;
    GLsizei count_ = 0;
};

}  // namespace render_node
