// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "shapes/model/height_range.hpp"
#include "shapes/model/open_sky.hpp"
#include "shapes/model/sand_rim.hpp"
#include "shapes/model/surface_parts.hpp"

namespace shapes {

/// Vertex of the sand, as the shader reads it.
struct GridVertex {
    float height;                          // [scene unit]
    std::uint16_t column, row;             // place in the vertex grid [half a cell]
    std::int16_t normalEast, normalNorth;  // 1/32767
    std::uint16_t open;                    // share of the sky that is visible from the vertex, 1/65535
    std::uint16_t mottling;                // slow change of shade from place to place, 1/65535
};
static_assert(sizeof(GridVertex) == 16);

/// Drawn surface of a height field, on the CPU: heights, normals and the visible share of the sky.
///
/// There is a vertex over the centre of each cell, and one more ring on the outer edges of the field. So a field of c ×
/// r cells has (c+2) × (r+2) vertices, and even one cell makes a surface. Not thread-safe.
class GridVertices {
public:
    /// Distance up to which a vertex depends on cells around its own [cell].
    static constexpr int kReach = kSkyDistances.back();
    // [cell], as in the sand's lists of changes, and as many as an AVX2 vector has floats.
    static constexpr int kBlock = 8;

    /// `ground` names the cells without ground; null if all have ground.
    explicit GridVertices(const sand::HeightField& field, const sand::Ground* ground = nullptr);

    /// Cells of one block that differed from the drawn ones: the smallest rectangle around them, and their earlier
    /// heights.
    struct Overwritten {
        sand::CellRect cells;
        HeightRange before;
    };
    /// Copies the heights of `cells`, which must lie within the field, and of the rest of their blocks. Reads each
    /// height once. Appends the cells that differed to `overwritten`.
    void takeOver(const sand::HeightField& field, const sand::CellRect& cells, std::vector<Overwritten>& overwritten);

    [[nodiscard]] int columns() const { return columns_; }      // [cell]
    [[nodiscard]] int rows() const { return rows_; }            // [cell]
    [[nodiscard]] float cellSize() const { return cellSize_; }  // [scene unit]
    /// Returns the height of the nearest cell of the field [scene unit].
    [[nodiscard]] float height(int column, int row) const;
    /// Returns the cells under a rectangle of the vertex grid. If the rectangle extends beyond the field, it returns
    /// the cells at the field's edge there.
    [[nodiscard]] sand::CellRect cellsUnder(const sand::CellRect& vertices) const;
    /// Returns the lowest and the highest height of these cells [scene unit]. `cells` must lie within the field and
    /// must not be empty.
    [[nodiscard]] HeightRange heights(const sand::CellRect& cells) const;
    /// Returns the number of heights that takeOver() and heights() have read. The range of a block counts as one.
    [[nodiscard]] std::int64_t placesRead() const { return placesRead_; }
    /// Returns the distance east of the field's corner, of a vertex column, or north of it, of a vertex row [scene
    /// unit].
    [[nodiscard]] float east(int vertexColumn) const { return along(vertexColumn, columns_); }
    [[nodiscard]] float north(int vertexRow) const { return along(vertexRow, rows_); }

    /// Returns the unit of GridVertex::column and row, which is half a cell: the corners of cells are whole numbers,
    /// too.
    [[nodiscard]] PlaceUniforms places() const { return {cellSize_ / 2, glm::vec2(2 * columns_, 2 * rows_), 1}; }

    /// Returns whether the nearest cell of the field has no ground. It never changes.
    [[nodiscard]] bool isHole(int column, int row) const;
    /// Returns whether a cell under these vertices has no ground.
    [[nodiscard]] bool hasHole(const sand::CellRect& vertices) const;

    /// Returns the edges of the sand.
    [[nodiscard]] SandRim rim() const;
    /// Returns whether a change of these cells may change rim().
    [[nodiscard]] bool touchesRim(const sand::CellRect& cells) const;

    /// Returns a vertex of the grid. A column or row beyond the grid repeats its last one.
    [[nodiscard]] GridVertex vertex(int column, int row) const;
    /// Writes neighbouring vertices of a row to `out`, starting with column `firstColumn`. Several times as fast as
    /// vertex().
    void vertices(int firstColumn, int row, std::span<GridVertex> out) const;
    /// Returns the vertices of a part of the grid, row by row from the south-west.
    [[nodiscard]] std::vector<GridVertex> verticesIn(const sand::CellRect& part) const;
    /// Returns the slope of the sand at a vertex, towards east and towards north.
    [[nodiscard]] glm::vec2 slope(int vertexColumn, int vertexRow) const;
    /// Returns the slow change of shade from place to place, 0 … 1.
    [[nodiscard]] float mottling(int vertexColumn, int vertexRow) const;

private:
    void takeOverBlock(const sand::HeightField& field, int blockX, int blockY, std::vector<Overwritten>& overwritten);
    class RangeByLanes;
    class BlockWalk;
    void add(const sand::CellRect& cells, RangeByLanes& range) const;
    void addFieldEdges(SandRim& rim) const;
    void addHoleEdges(SandRim& rim) const;
    void addEdgesOf(int column, int row, SandRim& rim) const;
    [[nodiscard]] static int blocksFor(int cells) { return (cells + kBlock - 1) / kBlock; }
    [[nodiscard]] std::size_t blockAt(int x, int y) const;
    [[nodiscard]] float along(int vertex, int cells) const;
    [[nodiscard]] GridVertex vertexUnder(float open, int column, int row) const;

    int columns_, rows_;
    float cellSize_;
    int blocksAcross_;
    std::vector<float> heights_;       // [scene unit], row by row
    std::vector<HeightRange> ranges_;  // of each block, row by row; they bound the heights of a large part quickly
    // Heights of each block's last column. The cells under a chunk begin one cell west of a block, and to read a column
    // of heights_ costs a cache miss a row.
    std::vector<HeightRange> lastColumns_;
    std::vector<std::uint8_t> holes_;  // 1 for a cell without ground; empty if all have ground
    mutable std::int64_t placesRead_ = 0;
};

}  // namespace shapes
