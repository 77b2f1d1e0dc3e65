// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/chunk_geometry.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace render_node {

ChunkGeometry::ChunkGeometry(const sand::CellRect& vertices, int level)
    : vertices_(vertices), stale_(vertices), sent_{level, {level, level, level, level}} {}

void ChunkGeometry::markStale(const sand::CellRect& vertices) {
    stale_ = stale_.joinedWith(vertices.clippedTo(vertices_));
}

bool ChunkGeometry::lacksVerticesOf(const ChunkLevels& levels) const {
    bool lacks = false;
    for (std::size_t edge = 0; edge < levels.edges.size(); ++edge) {
        lacks |= levels.edges[edge] < sent_.edges[edge];
    }
    return lacks;
}

std::size_t ChunkGeometry::refresh(const shapes::GridVertices& surface, const ChunkLevels& levels,
                                   const shapes::HoleEdges* holes, VertexPages& pages) {
    if (stale_.empty() && !lacksVerticesOf(levels)) {
        return 0;
    }
    const sand::CellRect stale = std::exchange(stale_, {});
    if (levels.level > 0 || range_.count() == 0 || holes != nullptr) {
        return writeAll(surface, levels, holes, pages);
    }
    std::vector<shapes::GridVertex> row(static_cast<std::size_t>(stale.x1 - stale.x0));
    const int across = vertices_.x1 - vertices_.x0;
    for (int y = stale.y0; y < stale.y1; ++y) {
        surface.vertices(stale.x0, y, row);
        pages.write(range_, (y - vertices_.y0) * across + stale.x0 - vertices_.x0, row);
    }
    return row.size() * static_cast<std::size_t>(stale.y1 - stale.y0);
}

std::size_t ChunkGeometry::writeAll(const shapes::GridVertices& surface, const ChunkLevels& levels,
                                    const shapes::HoleEdges* holes, VertexPages& pages) {
    std::vector<shapes::GridVertex> vertices = verticesOf(surface, vertices_, levels);
    sent_ = levels;
    if (holes != nullptr) {
        const std::vector<shapes::GridVertex> added = holes->added(vertices);
        vertices.insert(vertices.end(), added.begin(), added.end());
    }
    if (const auto count = static_cast<int>(vertices.size()); count != range_.count()) {
        range_ = {};  // allocate() may then return the same place
        range_ = pages.allocate(count);
    }
    pages.write(range_, 0, vertices);
    return computedVertices(vertices_, levels);
}

}  // namespace render_node
