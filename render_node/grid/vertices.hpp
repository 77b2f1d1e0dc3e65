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

    explicit SandSurface(const sand::HeightField& field);

    /// The smallest rectangle around those of these cells whose height is not drawn yet.
    [[nodiscard]] sand::CellRect differing(const sand::HeightField& field, const sand::CellRect& cells) const;
    /// Takes over the heights of these cells, which must lie within the field.
    void update(const sand::HeightField& field, const sand::CellRect& cells);

    [[nodiscard]] int columns() const { return columns_; }      // [cell]
    [[nodiscard]] int rows() const { return rows_; }            // [cell]
    [[nodiscard]] float cellSize() const { return cellSize_; }  // [scene unit]
    /// Height over the nearest cell of the field [scene unit].
    [[nodiscard]] float height(int column, int row) const;
    /// The lowest and the highest vertex of a rectangle of the vertex grid that may reach beyond it [scene unit].
    [[nodiscard]] HeightRange heights(const sand::CellRect& vertices) const;
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
    [[nodiscard]] float along(int vertex, int cells) const;
    [[nodiscard]] SandVertex vertexUnder(float open, int column, int row) const;

    int columns_, rows_;
    float cellSize_;
    std::vector<float> heights_;  // [scene unit], row by row
};

}  // namespace render_node
