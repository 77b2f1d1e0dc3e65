// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// A vertex of anything but the sand's surface. solid.vert.glsl takes it.
struct SolidVertex {
    glm::vec3 position;  // in the model's unit
    glm::vec3 normal;
    glm::vec2 along;  // along and across the grain of wood, in the model's unit
};

/// Triangles, counter-clockwise from outside, in GL. One thread, its context current.
class SolidMesh {
public:
    SolidMesh();
    /// Replaces the triangles: three vertices each.
    void set(const std::vector<SolidVertex>& triangles);
    /// The program must be in use.
    void draw() const { draw(0, count_); }
    /// Some of its triangles.
    void draw(GLint firstVertex, GLsizei vertices) const;

private:
    GlVertexArray array_;
    GlBuffer buffer_;
    GLsizei count_ = 0;
};

}  // namespace render_node
