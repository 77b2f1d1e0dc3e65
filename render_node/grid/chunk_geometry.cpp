// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/chunk_geometry.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace render_node {
namespace {

/// Describes the layout of GridVertex in the bound vertex array.
void describeVertex() {
    const auto attribute = [](GLuint index, GLint count, GLenum type, GLboolean normalised, std::size_t offset) {
        glEnableVertexAttribArray(index);
        glVertexAttribPointer(index, count, type, normalised, sizeof(shapes::GridVertex),
                              reinterpret_cast<const void*>(offset));
    };
    attribute(0, 1, GL_FLOAT, GL_FALSE, offsetof(shapes::GridVertex, height));
    attribute(1, 2, GL_UNSIGNED_SHORT, GL_FALSE, offsetof(shapes::GridVertex, column));
    attribute(2, 2, GL_SHORT, GL_TRUE, offsetof(shapes::GridVertex, normalEast));
    attribute(3, 2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(shapes::GridVertex, open));
}

GLintptr bytesOf(std::size_t vertices) { return static_cast<GLintptr>(vertices * sizeof(shapes::GridVertex)); }

}  // namespace

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
                                   const shapes::HoleEdges* holes) {
    if (stale_.empty() && !lacksVerticesOf(levels)) {
        return 0;
    }
    const sand::CellRect stale = std::exchange(stale_, {});
    if (levels.level > 0 || bytes_ == 0 || holes != nullptr) {
        return sendAll(surface, levels, holes);
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
    std::vector<shapes::GridVertex> row(static_cast<std::size_t>(stale.x1 - stale.x0));
    const int across = vertices_.x1 - vertices_.x0;
    for (int y = stale.y0; y < stale.y1; ++y) {
        surface.vertices(stale.x0, y, row);
        const int first = (y - vertices_.y0) * across + stale.x0 - vertices_.x0;
        glBufferSubData(GL_ARRAY_BUFFER, bytesOf(static_cast<std::size_t>(first)), bytesOf(row.size()), row.data());
    }
    return row.size() * static_cast<std::size_t>(stale.y1 - stale.y0);
}

void ChunkGeometry::bind(GLuint indices) {
    glBindVertexArray(array_.id());
    if (indices_ != indices) {  // the vertex array keeps it
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        indices_ = indices;
    }
}

std::size_t ChunkGeometry::sendAll(const shapes::GridVertices& surface, const ChunkLevels& levels,
                                   const shapes::HoleEdges* holes) {
    std::vector<shapes::GridVertex> vertices = verticesOf(surface, vertices_, levels);
    sent_ = levels;
    if (holes != nullptr) {
        const std::vector<shapes::GridVertex> added = holes->added(vertices);
        vertices.insert(vertices.end(), added.begin(), added.end());
    }
    const std::size_t before = std::exchange(bytes_, vertices.size() * sizeof(shapes::GridVertex));
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
    if (before == bytes_) {
        glBufferSubData(GL_ARRAY_BUFFER, 0, bytesOf(vertices.size()), vertices.data());
        return computedVertices(vertices_, levels);
    }
    glBufferData(GL_ARRAY_BUFFER, bytesOf(vertices.size()), vertices.data(), GL_DYNAMIC_DRAW);
    if (before == 0) {
        glBindVertexArray(array_.id());
        describeVertex();
    }
    return computedVertices(vertices_, levels);
}

}  // namespace render_node
