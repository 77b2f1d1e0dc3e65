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

void GridMesh::beginChoice(const LevelRule& rule) {
    if (chosenBy_ != rule || chosenRevision_ != revision_) {
        ++choice_;
        chosenBy_ = rule;
        chosenRevision_ = revision_;
    }
}

int GridMesh::levelOf(int x, int y, const LevelRule& rule) {
    Chunk& asked = chunk(x, y);
    if (asked.holes) {
        return 0;
    }
    if (asked.chosenFor != choice_) {
        asked.level = chooseLevel(asked, rule);
        asked.chosenFor = choice_;
    }
    return asked.level;
}

int GridMesh::chooseLevel(Chunk& asked, const LevelRule& rule) {
    if (rule.needsEveryCell()) {
        return 0;
    }
    const shapes::Box box = boxOf(asked.vertices, asked.heights);
    const double cell{surface_.cellSize()};
    if (asked.moving && rule.coarsensMovement()) {
        if (const std::optional<int> level = rule.levelWhileMoving(box, cell, layout_.coarsest)) {
            return *level;
        }
    }
    const int finest = rule.finest(box, cell, layout_.coarsest);
    return finest == layout_.coarsest ? finest
                                      : rule.level(box, errorsOfChunk(asked, finest), finest, layout_.coarsest);
}

/// Returns the errors of a chunk above this level. They do not depend on earlier drawings, so that all ranks choose
/// alike.
const LevelErrors& GridMesh::errorsOfChunk(Chunk& chunk, int finest) {
    auto& [last, before] = chunk.measured;
    if (last.from != finest) {
        std::swap(last, before);
    }
    if (last.from != finest) {
        last = {finest, errorsOf(surface_, chunk.vertices, sun_, finest, layout_.coarsest)};
        ++work_.measuredChunks;
    }
    return last.errors;
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
    beginChoice(rule);
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
    work_.vertices +=
        static_cast<std::int64_t>(found->refresh(surface_, levels, chunk.holes ? &*chunk.holes : nullptr, pages_));
    found->used = draws_;
    return *found;
}

const GridMesh::Indices& GridMesh::indicesOf(const ChunkLevels& levels) {
    const auto found = indices_.find(levels);
    if (found != indices_.end()) {
        return found->second;
    }
    const std::vector<std::uint16_t> made = trianglesOf(layout_.quadsAcross, layout_.quadsDown, levels);
    Indices indices{lists_.add(made), static_cast<int>(made.size()), {}};
    if (levels.level == 0) {
        indices.blocks = shapes::blocksOf(layout_.quadsAcross, layout_.quadsDown);
    }
    return indices_.emplace(levels, std::move(indices)).first->second;
}

const GridMesh::Indices& GridMesh::indicesOf(Chunk& chunk, const ChunkLevels& levels) {
    if (!chunk.holes) {
        return indicesOf(levels);
    }
    if (!chunk.indices) {
        const auto indices = chunk.holes->indices();
        const std::vector<std::uint16_t> made(indices.begin(), indices.end());
        chunk.indices = {lists_.add(made), static_cast<int>(made.size()), chunk.holes->blocks()};
    }
    return *chunk.indices;
}

void GridMesh::prepare(const GlProgram& program) const {
    const shapes::PlaceUniforms places = surface_.places();
    program.set("uCell", places.cell);
    program.set("uCells", places.cells);
    program.set("uFirst", places.first);
}

GridMesh::Drawn GridMesh::draw(const glm::dmat4& sceneToClip, bool culling, const LevelRule& rule,
                               const ProgramChoice& choose) {
    beginChoice(rule);
    ++draws_;
    shown_.clear();
    visitSeen(sceneToClip, culling, [&](int x, int y) {
        const ChunkLevels levels = levelsOf(x, y, rule);
        Chunk& seen = chunk(x, y);
        shown_.push_back({&seen, &geometryOf(seen, levels), &indicesOf(seen, levels)});
    });
    pages_.send();
    Drawn drawn;
    TriangleBatch batch(lists_.buffer(), pace_);
    for (const Shown& shown : shown_) {
        const GlProgram* program = choose ? &choose(boxOf(shown.chunk->vertices, shown.chunk->heights)) : nullptr;
        drawn.triangles += addTriangles(shown, program, culling ? &sceneToClip : nullptr, batch);
        drawn.coarseChunks += shown.geometry->level() > 0 ? 1 : 0;
        ++drawn.chunks;
    }
    batch.draw();
    dropUnused();
    return drawn;
}

int GridMesh::addTriangles(const Shown& shown, const GlProgram* program, const glm::dmat4* frustum,
                           TriangleBatch& batch) const {
    const auto& [chunk, geometry, indices] = shown;
    const auto add = [&, vertices = &geometry->range(), begin = indices->first](int first, int count) {
        batch.add(*vertices, program, begin + first, count);
    };
    if (frustum == nullptr || indices->blocks.empty()) {
        add(0, indices->count);
        return indices->count / 3;
    }
    int first = 0, count = 0, triangles = 0;  // first and count: adjacent blocks that are not added yet
    for (const shapes::TriangleBlock& block : indices->blocks) {
        const sand::CellRect vertices{chunk->vertices.x0 + block.quads.x0, chunk->vertices.y0 + block.quads.y0,
                                      chunk->vertices.x0 + block.quads.x1 + 1, chunk->vertices.y0 + block.quads.y1 + 1};
        if (!shapes::inFrustum(boxOf(vertices, chunk->heights), *frustum)) {
            continue;
        }
        triangles += block.count / 3;
        if (first + count == block.first) {
            count += block.count;
            continue;
        }
        if (count > 0) {
            add(first, count);
        }
        first = block.first;
        count = block.count;
    }
    if (count > 0) {
        add(first, count);
    }
    return triangles;
}

void GridMesh::dropUnused() {
    if (pages_.usedBytes() <= kManyBytes) {
        return;
    }
    for (Chunk& chunk : chunks_) {
        std::erase_if(chunk.geometries,
                      [this](const ChunkGeometry& geometry) { return geometry.used + kLately < draws_; });
    }
}

}  // namespace render_node
