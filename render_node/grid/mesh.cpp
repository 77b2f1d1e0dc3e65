// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/mesh.hpp"

#include <algorithm>
#include <cstddef>

#include "render_node/grid/changed_parts.hpp"

namespace render_node {
namespace {

constexpr int kGroup = 8;  // [chunk], side of a group

/// Returns the number of vertices in a page: a quarter of a megabyte of them, or all vertices of a small field.
int verticesPerPage(const shapes::ChunkLayout& layout) {
    constexpr std::int64_t kMost = 1 << 14;
    const std::int64_t ofChunk = std::int64_t{layout.quadsAcross + 1} * (layout.quadsDown + 1);
    return static_cast<int>(std::min(kMost, ofChunk * layout.across * layout.down));
}

}  // namespace

GridMesh::GridMesh(const sand::GridData& data, const glm::vec3& sun, int stepsPerSecond)
    : surface_(data.field, data.ground),
      sun_(sun),
      layout_(surface_.columns(), surface_.rows()),
      sharpening_(stepsPerSecond, static_cast<std::size_t>(sand::hashTilesAlong(surface_.columns()) *
                                                           sand::hashTilesAlong(surface_.rows()))),
      tiles_{0, 0, sand::hashTilesAlong(surface_.columns()), sand::hashTilesAlong(surface_.rows())},
      moving_(static_cast<std::size_t>(tiles_.x1 * tiles_.y1), 0),
      pages_(verticesPerPage(layout_)) {
    makeChunks();
    makeGroups();
    ever_ = groups_.front().heights;
    for (const Group& group : groups_) {
        ever_ = around(ever_, group.heights);
    }
}

void GridMesh::makeChunks() {
    chunks_.reserve(static_cast<std::size_t>(layout_.across) * static_cast<std::size_t>(layout_.down));
    for (int y = 0; y < layout_.down; ++y) {
        for (int x = 0; x < layout_.across; ++x) {
            Chunk& made = chunks_.emplace_back();
            made.vertices = layout_.vertices(x, y);
            made.heights = heightsUnder(made.vertices);
            if (surface_.hasHole(made.vertices)) {
                made.holes.emplace(surface_, made.vertices);
            }
        }
    }
}

void GridMesh::makeGroups() {
    for (int y = 0; y < layout_.down; y += kGroup) {
        for (int x = 0; x < layout_.across; x += kGroup) {
            Group group;
            group.chunks = {x, y, std::min(x + kGroup, layout_.across), std::min(y + kGroup, layout_.down)};
            group.vertices = {x * layout_.quadsAcross, y * layout_.quadsDown, group.chunks.x1 * layout_.quadsAcross + 1,
                              group.chunks.y1 * layout_.quadsDown + 1};
            group.heights = heightsUnder(group.vertices);
            groups_.push_back(group);
        }
    }
}

/// Returns the vertices that look different after these cells have changed.
sand::CellRect GridMesh::verticesOver(const sand::CellRect& cells) const {
    // Cell c lies under vertex c + 1. The normals and the shade of the vertices around it depend on the cell.
    const sand::CellRect reached =
        sand::CellRect{cells.x0 + 1, cells.y0 + 1, cells.x1 + 1, cells.y1 + 1}.grownBy(shapes::GridVertices::kReach);
    // The outermost ring repeats the ring next to it. Vertices of chunks beyond the grid repeat the outermost ring.
    const auto first = [](int vertex) { return vertex <= 1 ? 0 : vertex; };
    const auto end = [](int vertex, int count, int withBeyond) { return vertex > count ? withBeyond : vertex; };
    return {first(reached.x0), first(reached.y0),
            end(reached.x1, surface_.columns(), layout_.across * layout_.quadsAcross + 1),
            end(reached.y1, surface_.rows(), layout_.down * layout_.quadsDown + 1)};
}

bool GridMesh::update(const sand::SurfaceData& data, const sand::SurfaceChange& change, std::span<const glm::dmat4>) {
    const auto grid = std::get<sand::GridData>(data);
    const sand::HeightField& field = grid.field;
    std::vector<shapes::GridVertices::Overwritten> overwritten;
    if (change.whole) {
        surface_.takeOver(field, field.bounds(), overwritten);
    } else {
        for (const sand::CellRect& cells : std::get<sand::CellChange>(change.parts).cells) {
            surface_.takeOver(field, cells, overwritten);
        }
    }
    const std::vector<int> others = grid.movement == nullptr ? std::vector<int>() : followMovement(*grid.movement);
    if (overwritten.empty() && others.empty()) {
        return false;
    }
    ++revision_;
    std::ranges::for_each(others, [this](int tile) { markMoving(tile); });
    bool rim = false;
    for (const auto& [cells, before] : changedParts(overwritten, shapes::GridVertices::kReach + longestStride())) {
        const sand::CellRect vertices = verticesOver(cells);
        // A triangle that reaches these vertices may be higher or lower than they are, now or before the change.
        const shapes::HeightRange heights = around(heightsUnder(vertices.grownBy(longestStride())), before);
        changes_.add(revision_, {vertices, heights});
        ever_ = around(ever_, heights);
        rim |= surface_.touchesRim(cells);
    }
    for (const sand::CellRect& cells : changedTiles(overwritten)) {
        markChanged(chunksAround(verticesOver(cells)), verticesOver(cells));
    }
    return rim;
}

/// Returns the cells that have changed in each hash tile with changes. They are closer to the sand than changedParts(),
/// so that few chunks are computed although they look as before.
std::vector<sand::CellRect> GridMesh::changedTiles(
    std::span<const shapes::GridVertices::Overwritten> overwritten) const {
    static_assert(sand::kHashTile % shapes::GridVertices::kBlock == 0);
    std::vector<sand::CellRect> tiles(moving_.size());
    for (const auto& [cells, before] : overwritten) {
        sand::CellRect& tile =
            tiles[static_cast<std::size_t>(cells.y0 / sand::kHashTile * tiles_.x1 + cells.x0 / sand::kHashTile)];
        tile = tile.joinedWith(cells);
    }
    std::erase_if(tiles, [](const sand::CellRect& cells) { return cells.empty(); });
    return tiles;
}

std::vector<int> GridMesh::followMovement(const sand::Movement& movement) {
    std::vector<int> others;
    if (movingTiles_ == 0 && sharpening_.allSharp(movement)) {
        return others;
    }
    std::vector<std::uint8_t> moving;
    sharpening_.mark(movement, moving);
    for (std::size_t tile = 0; tile < moving.size(); ++tile) {
        if (moving[tile] != moving_[tile]) {
            others.push_back(static_cast<int>(tile));
        }
    }
    moving_ = std::move(moving);
    movingTiles_ = std::ranges::count(moving_, 1);
    return others;
}

/// Makes the chunks around a hash tile choose their levels again, because the tile began or ceased to count as moving.
void GridMesh::markMoving(int tile) {
    const int x0 = tile % tiles_.x1 * sand::kHashTile, y0 = tile / tiles_.x1 * sand::kHashTile;
    const sand::CellRect cells = sand::CellRect{x0, y0, x0 + sand::kHashTile, y0 + sand::kHashTile}.clippedTo(
        {0, 0, surface_.columns(), surface_.rows()});
    const sand::CellRect chunks = chunksAround(verticesOver(cells));
    for (int y = chunks.y0; y < chunks.y1; ++y) {
        for (int x = chunks.x0; x < chunks.x1; ++x) {
            Chunk& around = chunk(x, y);
            if (const bool moving = dependsOnMoving(around.vertices); moving != around.moving) {
                around.moving = moving;
                around.revision = groupOf(x, y).revision = revision_;
            }
        }
    }
}

/// Returns whether a hash tile that counts as moving has cells on which these vertices depend.
bool GridMesh::dependsOnMoving(const sand::CellRect& vertices) const {
    const sand::CellRect cells = surface_.cellsUnder(vertices.grownBy(shapes::GridVertices::kReach));
    const sand::CellRect tiles{cells.x0 / sand::kHashTile, cells.y0 / sand::kHashTile, sand::hashTilesAlong(cells.x1),
                               sand::hashTilesAlong(cells.y1)};
    for (int y = tiles.y0; y < tiles.y1; ++y) {
        const auto row = moving_.begin() + y * tiles_.x1;
        if (std::find(row + tiles.x0, row + tiles.x1, 1) != row + tiles.x1) {
            return true;
        }
    }
    return false;
}

GridMesh::Group& GridMesh::groupOf(int x, int y) {
    return groups_[static_cast<std::size_t>(y / kGroup * ((layout_.across + kGroup - 1) / kGroup) + x / kGroup)];
}

sand::CellRect GridMesh::chunksAround(const sand::CellRect& vertices) const {
    // A vertex on an edge belongs to both chunks.
    return sand::CellRect{(vertices.x0 - 1) / layout_.quadsAcross, (vertices.y0 - 1) / layout_.quadsDown,
                          (vertices.x1 - 1) / layout_.quadsAcross + 1, (vertices.y1 - 1) / layout_.quadsDown + 1}
        .clippedTo({0, 0, layout_.across, layout_.down});
}

void GridMesh::markChanged(const sand::CellRect& chunks, const sand::CellRect& vertices) {
    for (int y = chunks.y0; y < chunks.y1; ++y) {
        for (int x = chunks.x0; x < chunks.x1; ++x) {
            Chunk& changed = chunk(x, y);
            for (ChunkGeometry& geometry : changed.geometries) {
                geometry.markStale(vertices);
            }
            if (changed.marked == revision_) {
                continue;  // another part of this update has marked it
            }
            changed.marked = changed.revision = revision_;
            changed.measured = {};
            changed.heights = heightsUnder(changed.vertices);
            Group& group = groupOf(x, y);
            group.revision = revision_;
            group.heights = around(group.heights, changed.heights);
        }
    }
}

shapes::Box GridMesh::boxOf(const sand::CellRect& vertices, const shapes::HeightRange& heights) const {
    // A hundredth of a cell more, for rounding of GL's floats.
    const double margin = 0.01 * double{surface_.cellSize()};
    const glm::dvec3 low(surface_.east(vertices.x0), surface_.north(vertices.y0), heights.lowest);
    const glm::dvec3 high(surface_.east(vertices.x1 - 1), surface_.north(vertices.y1 - 1), heights.highest);
    return {low - margin, high + margin};
}

/// Returns whether the level of a chunk may be visible: in the chunk, or along the edges of the chunks around it.
bool GridMesh::mayMatter(int x, int y, const LevelRule& rule) const {
    const sand::CellRect beside =
        sand::CellRect{x - 1, y - 1, x + 2, y + 2}.clippedTo({0, 0, layout_.across, layout_.down});
    for (int v = beside.y0; v < beside.y1; ++v) {
        for (int u = beside.x0; u < beside.x1; ++u) {
            const Chunk& near = chunks_[static_cast<std::size_t>(v * layout_.across + u)];
            if (rule.sees(boxOf(near.vertices, near.heights))) {
                return true;
            }
        }
    }
    return false;
}

/// Returns the longest side along an axis of the triangles that are drawn at these vertices [cell].
int GridMesh::strideAround(const sand::CellRect& vertices, const DrawnLevels& levels) const {
    int level = 0;
    const sand::CellRect chunks = levels.empty() ? sand::CellRect{} : chunksAround(vertices);
    for (int y = chunks.y0; y < chunks.y1; ++y) {
        for (int x = chunks.x0; x < chunks.x1; ++x) {
            level = std::max(level, static_cast<int>(levels[static_cast<std::size_t>(y * layout_.across + x)]));
        }
    }
    return 1 << level;
}

/// Returns the box around these vertices and around `margin` more vertices on each side.
shapes::Box GridMesh::boxAround(const sand::CellRect& vertices, const shapes::HeightRange& heights, int margin) const {
    const sand::CellRect grid{0, 0, surface_.columns() + 2, surface_.rows() + 2};
    return boxOf(vertices.grownBy(margin).clippedTo(grid), heights);
}

std::vector<shapes::Box> GridMesh::changesSince(std::uint64_t revision, DrawnLevels& levels, const LevelRule& rule) {
    std::vector<shapes::Box> changed;
    for (const auto& [since, part] : changes_.since(revision)) {
        changed.push_back(boxAround(part.vertices, part.heights, strideAround(part.vertices, levels)));
    }
    updateLevels(levels, revision, rule, changed);
    return changed;
}

void GridMesh::updateLevels(DrawnLevels& levels, std::uint64_t revision, const LevelRule& rule,
                            std::vector<shapes::Box>& changed) {
    beginChoice(rule);
    for (const Group& group : groups_) {
        if (levels.empty() || group.revision <= revision) {
            continue;
        }
        for (int y = group.chunks.y0; y < group.chunks.y1; ++y) {
            for (int x = group.chunks.x0; x < group.chunks.x1; ++x) {
                std::int8_t& drawn = levels[static_cast<std::size_t>(y * layout_.across + x)];
                if (chunk(x, y).revision <= revision || (drawn < 0 && !mayMatter(x, y, rule))) {
                    continue;
                }
                if (drawn != levelOf(x, y, rule)) {
                    drawn = static_cast<std::int8_t>(levelOf(x, y, rule));
                    // The outermost triangles of the neighbours depend on this chunk's edges.
                    const sand::CellRect& vertices = chunk(x, y).vertices;
                    const shapes::HeightRange heights = heightsUnder(vertices.grownBy(longestStride()));
                    changed.push_back(boxAround(vertices, heights, strideAround(vertices, levels)));
                }
            }
        }
    }
}

}  // namespace render_node
