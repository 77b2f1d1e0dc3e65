// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render_node/surface/level_rule.hpp"
#include "shapes/grid/chunk_layout.hpp"
#include "shapes/grid/vertices.hpp"

namespace render_node {

/// Returns the errors of the levels above `finest` and up to `coarsest` in a rectangular part of the vertex grid,
/// compared with the vertices of the level `finest`. The errors of other levels are 0. 2^coarsest must divide the
/// numbers of quads along both sides. The part may extend beyond the field. `sun` points towards the sun and has length
/// 1.
[[nodiscard]] LevelErrors errorsOf(const shapes::GridVertices& surface, const sand::CellRect& vertices,
                                   const glm::vec3& sun, int finest, int coarsest);

/// Level of a chunk and of its four edges: south, east, north, west. No edge is coarser than the chunk.
struct ChunkLevels {
    int level = 0;
    std::array<int, 4> edges{};
    // clang-tidy 14 reports the 0 in the operator that it generates itself. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const ChunkLevels&, const ChunkLevels&) = default;
};

/// Returns the vertices of a chunk of side × side quads. The vertices of the level's grid come first, row by row from
/// the south-west. Above level 0 the four edges follow, counter-clockwise, up to the last one that is finer than the
/// chunk. They have a place for every vertex, but only those that a finer edge needs are computed. All others are 0.
[[nodiscard]] std::vector<shapes::GridVertex> verticesOf(const shapes::GridVertices& surface,
                                                         const sand::CellRect& vertices, const ChunkLevels& levels);

/// Returns how many of these vertices are computed.
[[nodiscard]] std::size_t computedVertices(const sand::CellRect& vertices, const ChunkLevels& levels);

/// Returns the triangles of a chunk as indices into verticesOf(), counter-clockwise from above. They use the vertices
/// of a chunk with these levels, or with finer edges. Neighbours that agree on the level of their common edge use the
/// same vertices there, so that there is no crack. Above level 0, 2^(level+1) must divide both sides.
[[nodiscard]] std::vector<std::uint16_t> trianglesOf(int quadsAcross, int quadsDown, const ChunkLevels& levels);

}  // namespace render_node
