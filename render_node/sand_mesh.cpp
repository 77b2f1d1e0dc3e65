// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace render_node {
namespace {

constexpr int kChunk = 32;  // [quad], the shortest side but for small fields

int chunksFor(int quads) { return std::max(1, quads / kChunk); }
int sideFor(int quads) { return (quads + chunksFor(quads) - 1) / chunksFor(quads); }

/// Writes how the shader finds a SandVertex's parts into the bound vertex array.
void describeVertex() {
    const auto attribute = [](GLuint index, GLint count, GLenum type, GLboolean normalised, std::size_t offset) {
        glEnableVertexAttribArray(index);
        glVertexAttribPointer(index, count, type, normalised, sizeof(SandVertex),
                              reinterpret_cast<const void*>(offset));
    };
    attribute(0, 1, GL_FLOAT, GL_FALSE, offsetof(SandVertex, height));
    attribute(1, 2, GL_UNSIGNED_SHORT, GL_FALSE, offsetof(SandVertex, column));
    attribute(2, 2, GL_SHORT, GL_TRUE, offsetof(SandVertex, normalEast));
    attribute(3, 2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(SandVertex, open));
}

}  // namespace

SandMesh::SandMesh(const sand::HeightField& field)
    : surface_(field),
      across_(chunksFor(field.columns() + 1)),
      down_(chunksFor(field.rows() + 1)),
      quadsAcross_(sideFor(field.columns() + 1)),
      quadsDown_(sideFor(field.rows() + 1)) {
    for (int y = 0; y < down_; ++y) {
        for (int x = 0; x < across_; ++x) {
            const sand::Rect vertices{x * quadsAcross_, y * quadsDown_, (x + 1) * quadsAcross_ + 1,
                                      (y + 1) * quadsDown_ + 1};
            Chunk& chunk = chunks_.emplace_back();
            chunk.vertices = vertices;
            measure(chunk);
        }
    }
    scratch_.resize(static_cast<std::size_t>(quadsAcross_ + 1) * static_cast<std::size_t>(quadsDown_ + 1));
    makeIndices();
}

void SandMesh::makeIndices() {
    std::vector<std::uint16_t> indices;
    indices.reserve(6 * static_cast<std::size_t>(quadsAcross_) * static_cast<std::size_t>(quadsDown_));
    const int stride = quadsAcross_ + 1;
    for (int y = 0; y < quadsDown_; ++y) {
        for (int x = 0; x < quadsAcross_; ++x) {
            const int southWest = y * stride + x;
            const int southEast = southWest + 1;
            const int northWest = southWest + stride;
            const int northEast = northWest + 1;
            // The diagonals alternate, so that ridges look alike in both diagonal directions.
            const std::array<int, 6> rising{southWest, southEast, northEast, southWest, northEast, northWest};
            const std::array<int, 6> falling{southWest, southEast, northWest, southEast, northEast, northWest};
            for (const int index : (x + y) % 2 == 0 ? rising : falling) {
                indices.push_back(static_cast<std::uint16_t>(index));
            }
        }
    }
    // Core profiles bind no element buffer without a vertex array; which one does not matter here.
    const GlVertexArray array;
    glBindVertexArray(array.id());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
    const std::size_t bytes = indices.size() * sizeof(indices[0]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), indices.data(), GL_STATIC_DRAW);
    bytes_ += bytes;
}

void SandMesh::measure(Chunk& chunk) const {
    chunk.lowest = chunk.highest = surface_.height(chunk.vertices.x0 - 1, chunk.vertices.y0 - 1);
    const int lastColumn = std::min(chunk.vertices.x1 - 1, surface_.columns() + 1) - 1;
    const int lastRow = std::min(chunk.vertices.y1 - 1, surface_.rows() + 1) - 1;
    for (int row = chunk.vertices.y0 - 1; row <= lastRow; ++row) {
        for (int column = chunk.vertices.x0 - 1; column <= lastColumn; ++column) {
            const float height = surface_.height(column, row);
            chunk.lowest = std::min(chunk.lowest, height);
            chunk.highest = std::max(chunk.highest, height);
        }
    }
}

void SandMesh::update(const sand::HeightField& field, const sand::Rect& cells) {
    if (cells.empty()) {
        return;
    }
    surface_.update(field, cells);
    // Cell c lies under vertex c + 1; normals and shade of the vertices around depend on it.
    constexpr int kAround = SandSurface::kReach + 1;
    const sand::Rect touched{cells.x0 + 1 - kAround, cells.y0 + 1 - kAround, cells.x1 + 1 + kAround,
                             cells.y1 + 1 + kAround};
    for (Chunk& chunk : chunks_) {
        if (!touched.clippedTo(chunk.vertices).empty()) {
            chunk.stale = true;
            measure(chunk);
        }
    }
}

bool SandMesh::seen(const Chunk& chunk, const glm::dmat4& sceneToClip) const {
    // A hundredth of a cell more, for what GL's floats may round.
    const double margin = 0.01 * surface_.cellSize();
    const std::array<double, 2> easts{surface_.east(chunk.vertices.x0) - margin,
                                      surface_.east(chunk.vertices.x1 - 1) + margin};
    const std::array<double, 2> norths{surface_.north(chunk.vertices.y0) - margin,
                                       surface_.north(chunk.vertices.y1 - 1) + margin};
    const std::array<double, 2> heights{chunk.lowest - margin, chunk.highest + margin};
    std::array<int, 6> outside{};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec4 clip =
            sceneToClip * glm::dvec4(easts[corner & 1U], norths[corner >> 1U & 1U], heights[corner >> 2U & 1U], 1);
        for (int axis = 0; axis < 3; ++axis) {
            outside[static_cast<std::size_t>(2 * axis)] += clip[axis] < -clip.w ? 1 : 0;
            outside[static_cast<std::size_t>(2 * axis + 1)] += clip[axis] > clip.w ? 1 : 0;
        }
    }
    return std::none_of(outside.begin(), outside.end(), [](int corners) { return corners == 8; });
}

void SandMesh::refresh(Chunk& chunk) {
    surface_.fill(chunk.vertices, scratch_);
    const auto bytes = static_cast<GLsizeiptr>(scratch_.size() * sizeof(SandVertex));
    if (!chunk.geometry) {
        chunk.geometry.emplace();
        glBindVertexArray(chunk.geometry->array.id());
        glBindBuffer(GL_ARRAY_BUFFER, chunk.geometry->vertices.id());
        glBufferData(GL_ARRAY_BUFFER, bytes, scratch_.data(), GL_DYNAMIC_DRAW);
        describeVertex();
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
        bytes_ += static_cast<std::size_t>(bytes);
    } else {
        glBindBuffer(GL_ARRAY_BUFFER, chunk.geometry->vertices.id());
        glBufferSubData(GL_ARRAY_BUFFER, 0, bytes, scratch_.data());
    }
    chunk.stale = false;
}

SandMesh::Drawn SandMesh::draw(const glm::dmat4& sceneToClip, bool culling) {
    Drawn drawn;
    for (Chunk& chunk : chunks_) {
        if (culling && !seen(chunk, sceneToClip)) {
            continue;
        }
        if (chunk.stale) {
            refresh(chunk);
        }
        glBindVertexArray(chunk.geometry->array.id());
        const int indices = 6 * quadsAcross_ * quadsDown_;
        glDrawElements(GL_TRIANGLES, indices, GL_UNSIGNED_SHORT, nullptr);
        ++drawn.chunks;
        drawn.triangles += indices / 3;
    }
    return drawn;
}

}  // namespace render_node
