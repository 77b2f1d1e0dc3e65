// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/solid_mesh.hpp"

#include <cstddef>

namespace render_node {

SolidMesh::SolidMesh() {
    glBindVertexArray(array_.id());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
    const auto attribute = [](GLuint index, GLint count, std::size_t offset) {
        glEnableVertexAttribArray(index);
        glVertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, sizeof(shapes::SolidVertex),
                              reinterpret_cast<const void*>(offset));
    };
    attribute(0, 3, offsetof(shapes::SolidVertex, position));
    attribute(1, 3, offsetof(shapes::SolidVertex, normal));
    attribute(2, 2, offsetof(shapes::SolidVertex, along));
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
