// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>

#include "render_node/gl/gl_handle.hpp"
#include "render_node/grid/vertices.hpp"

namespace render_node {

/// The vertices of a chunk at one level, in GL. Needs its context current.
class ChunkGeometry {
public:
    /// Nothing is computed before the first refresh().
    ChunkGeometry(const sand::CellRect& vertices, int level);

    /// The sand has changed the look of these vertices.
    void markStale(const sand::CellRect& vertices);
    /// Computes what is stale, and sends that.
    void refresh(const SandSurface& surface);
    [[nodiscard]] int level() const { return level_; }
    [[nodiscard]] GLuint array() const { return array_.id(); }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }  // since the first refresh()

    std::uint64_t used = 0;  // by which draw() last: its owner's

private:
    void sendAll(const SandSurface& surface);

    sand::CellRect vertices_, stale_;  // of the vertex grid
    int level_;
    std::size_t bytes_ = 0;
    GlVertexArray array_;
    GlBuffer buffer_;
};

}  // namespace render_node
