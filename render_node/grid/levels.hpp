// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render_node/grid/vertices.hpp"
#include "render_node/surface/level_rule.hpp"

namespace render_node {

/// The coarsest level that a field may have: at least 128 cells are left of its longer side. A change of the sand is
/// drawn anew as far as the largest triangle reaches: a level more would cost a hand that digs in a field of 512 cells
/// more than it saves.
[[nodiscard]] int coarsestLevel(int columns, int rows);

/// The errors of a square part of the vertex grid, which may reach beyond the field; levels above `coarsest` are left
/// 0. `sun` points towards it and has length 1.
[[nodiscard]] LevelErrors errorsOf(const SandSurface& surface, const sand::CellRect& vertices, const glm::vec3& sun,
                                   int coarsest);

/// The level that a chunk is drawn at, and those of its edges, none of which is coarser: south, east, north, west.
struct ChunkLevels {
    int level = 0;
    std::array<int, 4> edges{};
    // clang-tidy 14 complains of the 0 it finds in here itself. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const ChunkLevels&, const ChunkLevels&) = default;
};

/// Vertices of a chunk of side × side quads at one level: the grid row by row from the south-west, then, above level 0,
/// all vertices of the four edges counter-clockwise, for where a finer chunk or the rim lies beyond.
[[nodiscard]] std::vector<SandVertex> verticesOf(const SandSurface& surface, const sand::CellRect& vertices, int level);

/// Triangles side by side that stand together in trianglesOf(), so that a part of a chunk may be drawn.
struct TriangleBlock {
    sand::CellRect quads;
    int first, count;  // [index]
};
/// Those of level 0, of 8 × 8 quads each. A coarser level has few triangles and no blocks.
[[nodiscard]] std::vector<TriangleBlock> blocksOf(int quadsAcross, int quadsDown);

/// Triangles of such a chunk, counter-clockwise from above. Neighbours that agree on their common edge meet there in
/// the same vertices: no crack, whatever their levels. Above level 0, 2^(level+1) must divide the sides.
[[nodiscard]] std::vector<std::uint16_t> trianglesOf(int quadsAcross, int quadsDown, const ChunkLevels& levels);

}  // namespace render_node
