// SPDX-License-Identifier: Apache-2.0
// The part of GridMesh that draws: the levels of the chunks that a camera sees, their vertices and their triangles.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render_node/grid/mesh.hpp"

namespace render_node {
namespace {

// Memory of vertices [byte]; above it, vertices that were not drawn lately are removed.
constexpr std::size_t kManyBytes = 16UL << 20;
constexpr std::uint64_t kLately = 120;  // [draw]; one or two seconds

}  // namespace

template <class Visit>
void GridMesh::visitSeen(const glm::dmat4& sceneToClip, bool culling, const Visit& visit) {
    for (const Group& group : groups_) {
        if (culling && !shapes::inFrustum(boxOf(group.vertices, group.heights), sceneToClip)) {
            continue;
        }
        for (int y = group.chunks.y0; y < group.chunks.y1; ++y) {
            for (int x = group.chunks.x0; x < group.chunks.x1; ++x) {
                if (!culling || shapes::inFrustum(boxOf(chunk(x, y).vertices, chunk(x, y).heights), sceneToClip)) {
                    visit(x, y);
                }
            }
        }
    }
}

int GridMesh::levelOf(int x, int y, const LevelRule& rule) {
    Chunk& asked = chunk(x, y);
    if (asked.holes) {
        return 0;
    }
    if (asked.chosenFor != choice_) {
        const shapes::Box box = boxOf(asked.vertices, asked.heights);
        std::optional<int> level;
        if (asked.moving && rule.coarsensMovement()) {
            level = rule.levelWhileMoving(box, double{surface_.cellSize()}, layout_.coarsest);
        }
        asked.level = level ? *level : rule.level(box, errorsOfChunk(asked, rule), layout_.coarsest);
        asked.chosenFor = choice_;
    }
    return asked.level;
}

const LevelErrors& GridMesh::errorsOfChunk(Chunk& chunk, const LevelRule& rule) {
    if (!chunk.measured && !rule.needsEveryCell()) {
        chunk.errors = errorsOf(surface_, chunk.vertices, sun_, layout_.coarsest);
        chunk.measured = true;
        ++work_.measuredChunks;
    }
    return chunk.errors;
}

/// Returns the levels of a chunk and of its edges. The finer of two chunks determines their common edge. Edges at the
/// rim have level 0, because the cut sides of the sand have all vertices.
ChunkLevels GridMesh::levelsOf(int x, int y, const LevelRule& rule) {
    if (layout_.coarsest == 0) {
        return {};
    }
    ChunkLevels levels{levelOf(x, y, rule), {}};
    const auto edge = [&](int besideX, int besideY) {
        const bool rim = besideX < 0 || besideY < 0 || besideX == layout_.across || besideY == layout_.down;
        return rim ? 0 : std::min(levels.level, levelOf(besideX, besideY, rule));
    };
    levels.edges = {edge(x, y - 1), edge(x + 1, y), edge(x, y + 1), edge(x - 1, y)};
    return levels;
}

DrawnLevels GridMesh::levelsWithin(const glm::dmat4& sceneToClip, const LevelRule& rule) {
    if (layout_.coarsest == 0) {
        return {};
    }
    ++choice_;
    DrawnLevels levels(chunks_.size(), -1);
    visitSeen(sceneToClip, true, [&](int x, int y) {
        const sand::CellRect beside =
            sand::CellRect{x - 1, y - 1, x + 2, y + 2}.clippedTo({0, 0, layout_.across, layout_.down});
        for (int v = beside.y0; v < beside.y1; ++v) {
            for (int u = beside.x0; u < beside.x1; ++u) {
                levels[static_cast<std::size_t>(v * layout_.across + u)] =
                    static_cast<std::int8_t>(levelOf(u, v, rule));
            }
        }
    });
    return levels;
}

ChunkGeometry& GridMesh::geometryOf(Chunk& chunk, const ChunkLevels& levels) {
    auto found = std::ranges::find(chunk.geometries, levels.level, &ChunkGeometry::level);
    if (found == chunk.geometries.end()) {
        found = chunk.geometries.emplace(found, chunk.vertices, levels.level);
    }
    const std::size_t before = found->bytes();
    work_.vertices +=
        static_cast<std::int64_t>(found->refresh(surface_, levels, chunk.holes ? &*chunk.holes : nullptr));
    bytes_ += found->bytes() - before;
    found->used = choice_;
    return *found;
}

const GridMesh::Indices& GridMesh::indicesOf(const ChunkLevels& levels) {
    const auto found = indices_.find(levels);
    if (found != indices_.end()) {
        return found->second;
    }
    return indices_
        .try_emplace(levels, send(trianglesOf(layout_.quadsAcross, layout_.quadsDown, levels),
                                  levels.level == 0 ? shapes::blocksOf(layout_.quadsAcross, layout_.quadsDown)
                                                    : std::vector<shapes::TriangleBlock>()))
        .first->second;
}

const GridMesh::Indices& GridMesh::indicesOf(Chunk& chunk, const ChunkLevels& levels) {
    if (!chunk.holes) {
        return indicesOf(levels);
    }
    if (!chunk.indices) {
        const auto indices = chunk.holes->indices();
        chunk.indices = send(std::vector<std::uint16_t>(indices.begin(), indices.end()), chunk.holes->blocks());
    }
    return *chunk.indices;
}

GridMesh::Indices GridMesh::send(std::span<const std::uint16_t> indices, std::vector<shapes::TriangleBlock> blocks) {
    Indices made{{}, static_cast<int>(indices.size()), std::move(blocks)};
    // A core profile binds an element buffer only to a vertex array. Any vertex array will do here.
    const GlVertexArray array;
    glBindVertexArray(array.id());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, made.buffer.id());
    const std::size_t bytes = indices.size_bytes();
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), indices.data(), GL_STATIC_DRAW);
    bytes_ += bytes;
    return made;
}

void GridMesh::prepare(const GlProgram& program) const {
    const shapes::PlaceUniforms places = surface_.places();
    program.set("uCell", places.cell);
    program.set("uCells", places.cells);
    program.set("uFirst", places.first);
}

GridMesh::Drawn GridMesh::draw(const glm::dmat4& sceneToClip, bool culling, const LevelRule& rule,
                               const std::function<void(const shapes::Box&)>& before) {
    Drawn drawn;
    ++choice_;
    visitSeen(sceneToClip, culling, [&](int x, int y) {
        const ChunkLevels levels = levelsOf(x, y, rule);
        const Indices& indices = indicesOf(chunk(x, y), levels);
        ChunkGeometry& geometry = geometryOf(chunk(x, y), levels);
        if (before) {
            before(boxOf(chunk(x, y).vertices, chunk(x, y).heights));
        }
        geometry.bind(indices.buffer.id());
        const int triangles = drawTriangles(chunk(x, y), indices, culling ? &sceneToClip : nullptr);
        ++drawn.chunks;
        drawn.coarseChunks += levels.level > 0 ? 1 : 0;
        drawn.triangles += triangles;
        pace_.drawn(triangles);
    });
    dropUnused();
    return drawn;
}

/// Draws the blocks that reach into `frustum`, or all blocks if it is null. Returns the number of triangles.
int GridMesh::drawTriangles(const Chunk& chunk, const Indices& indices, const glm::dmat4* frustum) const {
    const auto draw = [](int first, int count) {
        glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_SHORT,
                       reinterpret_cast<const void*>(static_cast<std::size_t>(first) * sizeof(std::uint16_t)));
    };
    if (frustum == nullptr || indices.blocks.empty()) {
        draw(0, indices.count);
        return indices.count / 3;
    }
    int first = 0, count = 0, triangles = 0;  // first and count: adjacent blocks that are not drawn yet
    for (const shapes::TriangleBlock& block : indices.blocks) {
        const sand::CellRect vertices{chunk.vertices.x0 + block.quads.x0, chunk.vertices.y0 + block.quads.y0,
                                      chunk.vertices.x0 + block.quads.x1 + 1, chunk.vertices.y0 + block.quads.y1 + 1};
        if (!shapes::inFrustum(boxOf(vertices, chunk.heights), *frustum)) {
            continue;
        }
        triangles += block.count / 3;
        if (first + count == block.first) {
            count += block.count;
            continue;
        }
        if (count > 0) {
            draw(first, count);
        }
        first = block.first;
        count = block.count;
    }
    if (count > 0) {
        draw(first, count);
    }
    return triangles;
}

void GridMesh::dropUnused() {
    if (bytes_ <= kManyBytes) {
        return;
    }
    for (Chunk& chunk : chunks_) {
        std::erase_if(chunk.geometries, [this](const ChunkGeometry& geometry) {
            const bool unused = geometry.used + kLately < choice_;
            bytes_ -= unused ? geometry.bytes() : 0;
            return unused;
        });
    }
}

}  // namespace render_node
