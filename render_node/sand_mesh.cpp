// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace render_node {
namespace {

constexpr int kChunk = 32;  // [quad], the shortest side but for small fields

constexpr int kMostChanges = 36;  // of one update

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
      software_(drawnByLlvmpipe()),
      ever_(surface_.heights({0, 0, field.columns() + 2, field.rows() + 2})) {
    for (int y = 0; y < down_; ++y) {
        for (int x = 0; x < across_; ++x) {
            const sand::Rect vertices{x * quadsAcross_, y * quadsDown_, (x + 1) * quadsAcross_ + 1,
                                      (y + 1) * quadsDown_ + 1};
            chunks_.push_back({vertices, surface_.heights(vertices), true, {}});
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

std::vector<SandMesh::Change> SandMesh::changesOf(const sand::HeightField& field, const sand::Rect& cells) const {
    // Small parts follow the sand closely, few parts are soon looked through.
    int side = kChunk;
    while ((cells.x1 - cells.x0 + side - 1) / side * ((cells.y1 - cells.y0 + side - 1) / side) > kMostChanges) {
        side *= 2;
    }
    // Cell c lies under vertex c + 1; normals and shade of the vertices around depend on it, and triangles reach from
    // these a vertex further.
    constexpr int kAround = SandSurface::kReach + 1;
    const sand::Rect grid{0, 0, surface_.columns() + 2, surface_.rows() + 2};
    std::vector<Change> changes;
    for (int y = cells.y0; y < cells.y1; y += side) {
        for (int x = cells.x0; x < cells.x1; x += side) {
            const sand::Rect changed = surface_.differing(field, sand::Rect{x, y, x + side, y + side}.clippedTo(cells));
            if (!changed.empty()) {
                const sand::Rect vertices =
                    sand::Rect{changed.x0 + 1, changed.y0 + 1, changed.x1 + 1, changed.y1 + 1}.grownBy(kAround);
                changes.push_back({vertices.clippedTo(grid), surface_.heights(vertices)});
            }
        }
    }
    return changes;
}

void SandMesh::update(const sand::HeightField& field, const sand::Rect& cells) {
    const std::vector<Change> changes = changesOf(field, cells);
    if (changes.empty()) {
        return;
    }
    surface_.update(field, cells);
    ++revision_;
    for (const Change& change : changes) {
        const HeightRange after = surface_.heights(change.vertices);
        const HeightRange heights{std::min(change.before.lowest, after.lowest),
                                  std::max(change.before.highest, after.highest)};
        damage_.add(revision_, boxOf(change.vertices, heights));
        ever_ = {std::min(ever_.lowest, heights.lowest), std::max(ever_.highest, heights.highest)};
    }
    for (Chunk& chunk : chunks_) {
        if (std::any_of(changes.begin(), changes.end(),
                        [&](const Change& change) { return !change.vertices.clippedTo(chunk.vertices).empty(); })) {
            chunk.stale = true;
            chunk.heights = surface_.heights(chunk.vertices);
        }
    }
}

Box SandMesh::boxOf(const sand::Rect& vertices, const HeightRange& heights) const {
    // A hundredth of a cell more, for what GL's floats may round.
    const double margin = 0.01 * double{surface_.cellSize()};
    const glm::dvec3 low(surface_.east(vertices.x0), surface_.north(vertices.y0), heights.lowest);
    const glm::dvec3 high(surface_.east(vertices.x1 - 1), surface_.north(vertices.y1 - 1), heights.highest);
    return {low - margin, high + margin};
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

SandMesh::Drawn SandMesh::draw(const glm::dmat4& sceneToClip, bool culling,
                               const std::function<void(const Box&)>& before) {
    Drawn drawn;
    int waiting = 0;  // triangles
    for (Chunk& chunk : chunks_) {
        const Box box = boxOf(chunk.vertices, chunk.heights);
        if (culling && !inFrustum(box, sceneToClip)) {
            continue;
        }
        if (chunk.stale) {
            refresh(chunk);
        }
        if (before) {
            before(box);
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
