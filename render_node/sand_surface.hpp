// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sand/height_field.hpp"

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

struct HeightRange {
    float lowest, highest;  // [scene unit]
};

/// The drawn surface of a height field, on the CPU: heights, normals and how much sky each place sees.
///
/// Vertices stand over the cells' centres, and one more ring on the outer edges of the field: a field of c × r cells
/// has (c+2) × (r+2) vertices, and even one cell is a surface. Not thread-safe.
class SandSurface {
public:
    /// A vertex depends on cells up to this far from its own [cell].
    static constexpr int kReach = 10;

    explicit SandSurface(const sand::HeightField& field);

    /// The smallest rectangle around those of these cells whose height is not drawn yet.
    [[nodiscard]] sand::Rect differing(const sand::HeightField& field, const sand::Rect& cells) const;
    /// Takes over the heights of these cells, which must lie within the field.
    void update(const sand::HeightField& field, const sand::Rect& cells);

    [[nodiscard]] int columns() const { return columns_; }      // [cell]
    [[nodiscard]] int rows() const { return rows_; }            // [cell]
    [[nodiscard]] float cellSize() const { return cellSize_; }  // [scene unit]
    /// Height over the nearest cell of the field [scene unit].
    [[nodiscard]] float height(int column, int row) const;
    /// The lowest and the highest vertex of a rectangle of the vertex grid that may reach beyond it [scene unit].
    [[nodiscard]] HeightRange heights(const sand::Rect& vertices) const;
    /// East (from a vertex column) or north (from a vertex row) of the field's corner [scene unit].
    [[nodiscard]] float east(int vertexColumn) const { return along(vertexColumn, columns_); }
    [[nodiscard]] float north(int vertexRow) const { return along(vertexRow, rows_); }

    /// Writes the vertices of a rectangle of the vertex grid, row by row. A column or row beyond the grid repeats its
    /// last one. `out` holds exactly the rectangle.
    void fill(const sand::Rect& vertices, std::span<SandVertex> out) const;

private:
    [[nodiscard]] float along(int vertex, int cells) const;
    [[nodiscard]] SandVertex vertexAt(int column, int row) const;
    [[nodiscard]] float openSky(int column, int row) const;

    int columns_, rows_;
    float cellSize_;
    std::vector<float> heights_;  // [scene unit], row by row
};

}  // namespace render_node
