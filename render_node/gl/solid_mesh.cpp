// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/solid_mesh.hpp"

#include <cstddef>

#include "render_node/gl/vertex_attribute.hpp"

namespace render_node {

SolidMesh::SolidMesh() {
    glBindVertexArray(array_.id());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
    constexpr auto attribute = describeAttribute<shapes::SolidVertex>;
    attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(shapes::SolidVertex, position));
    attribute(1, 3, GL_FLOAT, GL_FALSE, offsetof(shapes::SolidVertex, normal));
    attribute(2, 2, GL_FLOAT, GL_FALSE, offsetof(shapes::SolidVertex, along));
}

void SolidMesh::set(const std::vector<shapes::SolidVertex>& triangles) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof(shapes::SolidVertex)),
                 triangles.data(), GL_DYNAMIC_DRAW);
    count_ = static_cast<GLsizei>(triangles.size());
}

void SolidMesh::draw(GLint firstVertex, GLsizei vertices) const {
    glBindVertexArray(array_.id());
    glDrawArrays(GL_TRIANGLES, firstVertex, vertices);
}

}  // namespace render_node
