// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render_node/gl/gl_handle.hpp"
#include "shapes/model/solid_vertex.hpp"

namespace render_node {

/// Triangles in GL, counter-clockwise seen from outside. Used by one thread, with its context current.
class SolidMesh {
public:
    SolidMesh();
    /// Replaces the triangles. Each triangle has three vertices.
    void set(const std::vector<shapes::SolidVertex>& triangles);
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
