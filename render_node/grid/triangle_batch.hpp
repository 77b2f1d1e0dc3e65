// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <glad/gl.h>

#include <cstddef>
#include <vector>

#include "render_node/gl/gl_program.hpp"
#include "render_node/gl/triangle_pace.hpp"
#include "render_node/grid/vertex_pages.hpp"

namespace render_node {

/// Draws triangles of many chunks, in the order in which they are added. Chunks in one page with one program travel in
/// one call. A call and its vertex array take a driver longer than the few triangles of a distant chunk.
///
/// Used by one thread, with its context current. No page and no index may change while it exists.
class TriangleBatch {
public:
    /// `indices` is the buffer of all indices.
    TriangleBatch(GLuint indices, TrianglePace& pace) : indices_(indices), pace_(&pace) {}
    TriangleBatch(const TriangleBatch&) = delete;
    TriangleBatch& operator=(const TriangleBatch&) = delete;

    /// Adds `count` indices from place `first` on, which count from the first vertex of `vertices`. Null for `program`
    /// means the one in use.
    void add(const VertexPages::Range& vertices, const GlProgram* program, int first, int count);
    /// Draws what has been added since the last draw.
    void draw();

private:
    GLuint indices_;
    TrianglePace* pace_;
    const VertexPages::Range* vertices_ = nullptr;  // of the chunk that was added last
    const GlProgram* program_ = nullptr;            // of the chunks that wait
    std::vector<GLsizei> counts_;
    std::vector<const void*> places_;
    std::vector<GLint> bases_;
    int triangles_ = 0;
};

}  // namespace render_node
