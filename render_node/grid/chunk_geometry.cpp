// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/chunk_geometry.hpp"

#include <cstddef>
#include <span>
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

void ChunkGeometry::refresh(const shapes::GridVertices& surface, const ChunkLevels& levels,
                            const shapes::HoleEdges* holes) {
    if (stale_.empty() && !lacksVerticesOf(levels)) {
        return;
    }
    if (levels.level > 0 || bytes_ == 0 || holes != nullptr) {
        sendAll(surface, levels, holes);
    } else {
        glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
        std::vector<shapes::GridVertex> row(static_cast<std::size_t>(stale_.x1 - stale_.x0));
        const int across = vertices_.x1 - vertices_.x0;
        for (int y = stale_.y0; y < stale_.y1; ++y) {
            surface.vertices(stale_.x0, y, row);
            const int first = (y - vertices_.y0) * across + stale_.x0 - vertices_.x0;
            glBufferSubData(GL_ARRAY_BUFFER, bytesOf(static_cast<std::size_t>(first)), bytesOf(row.size()), row.data());
        }
    }
    stale_ = {};
}

void ChunkGeometry::sendAll(const shapes::GridVertices& surface, const ChunkLevels& levels,
                            const shapes::HoleEdges* holes) {
    std::vector<shapes::GridVertex> vertices = verticesOf(surface, vertices_, levels);
    sent_ = levels;
    if (holes != nullptr) {
        const std::vector<shapes::GridVertex> added = holes->added(vertices);
        vertices.insert(vertices.end(), added.begin(), added.end());
    }
    const bool first = bytes_ == 0;
    bytes_ = vertices.size() * sizeof(shapes::GridVertex);
    glBindVertexArray(array_.id());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
    glBufferData(GL_ARRAY_BUFFER, bytesOf(vertices.size()), vertices.data(), GL_DYNAMIC_DRAW);
    if (first) {
        describeVertex();
    }
}

}  // namespace render_node
