// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render_node/surface/height_range.hpp"
#include "render_node/surface/open_sky.hpp"
#include "render_node/surface/sand_rim.hpp"
#include "sand/model/height_field.hpp"

namespace render_node {

/// A vertex of the sand as the shader takes it.
struct SandVertex {
    float height;                          // [scene unit]
    std::uint16_t column, row;             // of the vertex grid
    std::int16_t normalEast, normalNorth;  // 1/32767
    std::uint16_t open;                    // share of the sky that the vertex sees, 1/65535
    std::uint16_t mottling;                // slow change of shade from place to place, 1/65535
};
static_assert(sizeof(SandVertex) == 16);

/// The drawn surface of a height field, on the CPU: heights, normals and how much sky each place sees.
///
/// Vertices stand over the cells' centres, and one more ring on the outer edges of the field: a field of c × r cells
/// has (c+2) × (r+2) vertices, and even one cell is a surface. Not thread-safe.
class SandSurface {
public:
    /// A vertex depends on cells up to this far from its own [cell].
    static constexpr int kReach = kSkyDistances.back();
    static constexpr int kBlock = 8;  // [cell], as those of the changes that sand lists, and a vector of AVX2

    explicit SandSurface(const sand::HeightField& field);

    /// Cells of one block that differed from what was drawn: the smallest rectangle around them, and the heights they
    /// had.
    struct Overwritten {
        sand::CellRect cells;
        HeightRange before;
    };
    /// Takes over the heights of these cells, which must lie within the field, and of the rest of their blocks. Reads
    /// each once. Appends what differed to `overwritten`.
    void takeOver(const sand::HeightField& field, const sand::CellRect& cells, std::vector<Overwritten>& overwritten);

    [[nodiscard]] int columns() const { return columns_; }      // [cell]
    [[nodiscard]] int rows() const { return rows_; }            // [cell]
    [[nodiscard]] float cellSize() const { return cellSize_; }  // [scene unit]
    /// Height over the nearest cell of the field [scene unit].
    [[nodiscard]] float height(int column, int row) const;
    /// The cells under a rectangle of the vertex grid that may reach beyond it; beyond the field, those at its edge.
    [[nodiscard]] sand::CellRect cellsUnder(const sand::CellRect& vertices) const;
    /// The lowest and the highest of these cells, which must lie within the field and be some [scene unit].
    [[nodiscard]] HeightRange heights(const sand::CellRect& cells) const;
    /// Heights that takeOver() and heights() have read, a block's range as one.
    [[nodiscard]] std::int64_t placesRead() const { return placesRead_; }
    /// East (from a vertex column) or north (from a vertex row) of the field's corner [scene unit].
    [[nodiscard]] float east(int vertexColumn) const { return along(vertexColumn, columns_); }
    [[nodiscard]] float north(int vertexRow) const { return along(vertexRow, rows_); }

    /// Where the field ends.
    [[nodiscard]] SandRim rim() const;
    /// Whether a change of these cells changes it.
    [[nodiscard]] bool touchesRim(const sand::CellRect& cells) const {
        return !cells.empty() && (cells.x0 <= 0 || cells.y0 <= 0 || cells.x1 >= columns_ || cells.y1 >= rows_);
    }

    /// A vertex of the grid. A column or row beyond the grid repeats its last one.
    [[nodiscard]] SandVertex vertex(int column, int row) const;
    /// The same for neighbours in a row, from this column on; several times as fast.
    void vertices(int firstColumn, int row, std::span<SandVertex> out) const;
    /// How steeply the sand rises there towards east and north.
    [[nodiscard]] glm::vec2 slope(int vertexColumn, int vertexRow) const;
    /// Slow change of shade from place to place, 0 … 1.
    [[nodiscard]] float mottling(int vertexColumn, int vertexRow) const;

private:
    void takeOverBlock(const sand::HeightField& field, int blockX, int blockY, std::vector<Overwritten>& overwritten);
    class RangeByLanes;
    class BlockWalk;
    void add(const sand::CellRect& cells, RangeByLanes& range) const;
    [[nodiscard]] static int blocksFor(int cells) { return (cells + kBlock - 1) / kBlock; }
    [[nodiscard]] std::size_t blockAt(int x, int y) const;
    [[nodiscard]] float along(int vertex, int cells) const;
    [[nodiscard]] SandVertex vertexUnder(float open, int column, int row) const;

    int columns_, rows_;
    float cellSize_;
    int blocksAcross_;
    std::vector<float> heights_;       // [scene unit], row by row
    std::vector<HeightRange> ranges_;  // of each block, row by row: few heights tell how high a large part is
    mutable std::int64_t placesRead_ = 0;
};

}  // namespace render_node
