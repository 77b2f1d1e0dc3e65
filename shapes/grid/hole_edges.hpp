// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "shapes/grid/chunk_layout.hpp"
#include "shapes/grid/vertices.hpp"

namespace shapes {

/// Returns the mean height of the cells around a corner of the cells, without holes. `heights` and `ground` have the
/// cells around it counter-clockwise. If only two opposite cells have ground, their sand does not join, and the height
/// is that of cell `own`.
[[nodiscard]] float cornerHeight(const std::array<float, 4>& heights, const std::array<bool, 4>& ground,
                                 std::size_t own);

/// Triangles of a chunk at level 0 that has cells without ground. Each quad between four cells is cut along the edges
/// of the cells. Cells and holes never change, so that only the vertices follow the sand.
class HoleEdges {
public:
    HoleEdges(const GridVertices& surface, const sand::CellRect& vertices);

    /// Returns the indices of the triangles. They count the vertices of the chunk's grid first, row by row from the
    /// south-west, and then those of added().
    [[nodiscard]] std::span<const std::uint32_t> indices() const { return indices_; }
    /// Returns the blocks of the triangles, as blocksOf() does.
    [[nodiscard]] const std::vector<TriangleBlock>& blocks() const { return blocks_; }
    /// Returns the number of vertices that added() returns.
    [[nodiscard]] std::size_t addedCount() const { return added_.size(); }
    /// Returns the vertices on the edges of cells. `grid` has the vertices of the chunk's grid.
    [[nodiscard]] std::vector<GridVertex> added(std::span<const GridVertex> grid) const;

private:
    /// Vertex on the edge of a cell, or on its corner: the mean of vertices of the grid.
    struct Added {
        std::uint16_t column = 0, row = 0;    // place in the vertex grid [half a cell]
        std::array<std::uint32_t, 4> from{};  // numbers in the chunk's grid
        std::uint8_t count = 0;               // of `from`
    };
    void addQuad(const GridVertices& surface, int x, int y);
    /// Adds the quarters of a quad that belong to the cells `ground`, as one piece.
    void addPiece(const std::array<std::uint32_t, 4>& corners, const std::array<bool, 4>& ground);
    [[nodiscard]] std::uint32_t add(const Added& vertex);
    [[nodiscard]] int placeOf(std::uint32_t corner, int axis) const;
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

    sand::CellRect vertices_;
    int columns_, rows_;  // of the field
    std::vector<std::uint32_t> indices_;
    std::vector<TriangleBlock> blocks_;
    std::vector<Added> added_;
};

}  // namespace shapes
