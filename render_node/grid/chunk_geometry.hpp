// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>

#include "render_node/gl/gl_handle.hpp"
#include "render_node/grid/levels.hpp"
#include "shapes/grid/hole_edges.hpp"
#include "shapes/grid/vertices.hpp"

namespace render_node {

/// Vertices of a chunk at one level, in GL. The GL context must be current.
class ChunkGeometry {
public:
    /// Stores the rectangle and the level. The first refresh() computes the vertices.
    ChunkGeometry(const sand::CellRect& vertices, int level);

    /// Marks vertices whose look the sand has changed.
    void markStale(const sand::CellRect& vertices);
    /// Computes the marked vertices, and those of edges that have become finer, and sends them to GL. The level of
    /// `levels` is this level. `holes` belongs to a chunk with holes, at level 0. Returns how many
    /// vertices it has computed.
    std::size_t refresh(const shapes::GridVertices& surface, const ChunkLevels& levels, const shapes::HoleEdges* holes);
    [[nodiscard]] int level() const { return sent_.level; }
    /// Binds the vertices, and `indices` as the buffer of their indices.
    void bind(GLuint indices);
    [[nodiscard]] std::size_t bytes() const { return bytes_; }  // memory in GL; 0 before the first refresh()

    std::uint64_t used = 0;  // number of the draw() that used it last; the owner sets it

private:
    [[nodiscard]] bool lacksVerticesOf(const ChunkLevels& levels) const;
    std::size_t sendAll(const shapes::GridVertices& surface, const ChunkLevels& levels, const shapes::HoleEdges* holes);

    sand::CellRect vertices_, stale_;  // of the vertex grid
    ChunkLevels sent_;
    std::size_t bytes_ = 0;
    GLuint indices_ = 0;  // buffer that is bound to the vertex array
    GlVertexArray array_;
    GlBuffer buffer_;
};

}  // namespace render_node
