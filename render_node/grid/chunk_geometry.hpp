// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>

#include "render_node/grid/levels.hpp"
#include "render_node/grid/vertex_pages.hpp"
#include "shapes/grid/hole_edges.hpp"
#include "shapes/grid/vertices.hpp"

namespace render_node {

/// Vertices of a chunk at one level, in a page. The GL context must be current.
class ChunkGeometry {
public:
    /// Stores the rectangle and the level. The first refresh() computes the vertices.
    ChunkGeometry(const sand::CellRect& vertices, int level);

    /// Marks vertices whose look the sand has changed.
    void markStale(const sand::CellRect& vertices);
    /// Computes the marked vertices, and those of edges that have become finer, and writes them to `pages`. The level
    /// of `levels` is this level. `holes` belongs to a chunk with holes, at level 0. Returns how many vertices it has
    /// computed.
    std::size_t refresh(const shapes::GridVertices& surface, const ChunkLevels& levels, const shapes::HoleEdges* holes,
                        VertexPages& pages);
    [[nodiscard]] int level() const { return sent_.level; }
    /// Place of the vertices. Empty before the first refresh().
    [[nodiscard]] const VertexPages::Range& range() const { return range_; }

    std::uint64_t used = 0;  // number of the draw() that used it last; the owner sets it

private:
    [[nodiscard]] bool lacksVerticesOf(const ChunkLevels& levels) const;
    std::size_t writeAll(const shapes::GridVertices& surface, const ChunkLevels& levels, const shapes::HoleEdges* holes,
                         VertexPages& pages);

    sand::CellRect vertices_, stale_;  // of the vertex grid
    ChunkLevels sent_;
    VertexPages::Range range_;
};

}  // namespace render_node
