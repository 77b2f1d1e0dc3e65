// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

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

// llvmpipe keeps some 270 bytes for each triangle until it fills pixels, in scenes of 36 MB that it never returns: a
// field of 512 x 512 cells held 110 MB. Filling pixels more often bounds that, and costs no time that can be measured.
constexpr int kTrianglesPerFinish = 32768;

bool drawnByLlvmpipe() {
    const GLubyte* renderer = glGetString(GL_RENDERER);
    return renderer != nullptr && std::string_view(reinterpret_cast<const char*>(renderer)).starts_with("llvmpipe");
}

}  // namespace

SandMesh::SandMesh(const sand::HeightField& field)
    : surface_(field),
      across_(chunksFor(field.columns() + 1)),
      down_(chunksFor(field.rows() + 1)),
      quadsAcross_(sideFor(field.columns() + 1)),
      quadsDown_(sideFor(field.rows() + 1)),
      software_(drawnByLlvmpipe()) {
    for (int y = 0; y < down_; ++y) {
        for (int x = 0; x < across_; ++x) {
            const sand::Rect vertices{x * quadsAcross_, y * quadsDown_, (x + 1) * quadsAcross_ + 1,
                                      (y + 1) * quadsDown_ + 1};
            Chunk& chunk = chunks_.emplace_back();
            chunk.vertices = vertices;
            measure(chunk);
            chunk.lowestEver = chunk.lowest;
            chunk.highestEver = chunk.highest;
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
    ++revision_;
    // Cell c lies under vertex c + 1; normals and shade of the vertices around depend on it.
    constexpr int kAround = SandSurface::kReach + 1;
    const sand::Rect touched{cells.x0 + 1 - kAround, cells.y0 + 1 - kAround, cells.x1 + 1 + kAround,
                             cells.y1 + 1 + kAround};
    for (Chunk& chunk : chunks_) {
        if (!touched.clippedTo(chunk.vertices).empty()) {
            chunk.stale = true;
            chunk.changed = revision_;
            measure(chunk);
            chunk.lowestEver = std::min(chunk.lowestEver, chunk.lowest);
            chunk.highestEver = std::max(chunk.highestEver, chunk.highest);
        }
    }
}

Box SandMesh::boxOf(const Chunk& chunk, float lowest, float highest) const {
    // A hundredth of a cell more, for what GL's floats may round.
    const double margin = 0.01 * double{surface_.cellSize()};
    const glm::dvec3 low(surface_.east(chunk.vertices.x0), surface_.north(chunk.vertices.y0), lowest);
    const glm::dvec3 high(surface_.east(chunk.vertices.x1 - 1), surface_.north(chunk.vertices.y1 - 1), highest);
    return {low - margin, high + margin};
}

bool SandMesh::changedInView(const glm::dmat4& sceneToClip, std::uint64_t since) const {
    return std::any_of(chunks_.begin(), chunks_.end(), [&](const Chunk& chunk) {
        return chunk.changed > since && inFrustum(boxOf(chunk, chunk.lowestEver, chunk.highestEver), sceneToClip);
    });
}

float SandMesh::lowestEver() const {
    return std::min_element(chunks_.begin(), chunks_.end(),
                            [](const Chunk& a, const Chunk& b) { return a.lowestEver < b.lowestEver; })
        ->lowestEver;
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
    int waiting = 0;  // triangles
    for (Chunk& chunk : chunks_) {
        if (culling && !inFrustum(boxOf(chunk, chunk.lowest, chunk.highest), sceneToClip)) {
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
        waiting += indices / 3;
        if (software_ && waiting >= kTrianglesPerFinish) {
            glFinish();
            waiting = 0;
        }
    }
    return drawn;
}

}  // namespace render_node
