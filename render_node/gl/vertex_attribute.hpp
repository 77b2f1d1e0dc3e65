// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glad/gl.h>

#include <cstddef>

namespace render_node {

/// Describes one attribute of a Vertex in the bound vertex array: `count` numbers of `type` that begin `offset` bytes
/// into the vertex. A vertex buffer must be bound.
template <class Vertex>
void describeAttribute(GLuint index, GLint count, GLenum type, GLboolean normalised, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, count, type, normalised, sizeof(Vertex), reinterpret_cast<const void*>(offset));
}

}  // namespace render_node
