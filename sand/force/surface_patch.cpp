// SPDX-License-Identifier: Apache-2.0
#include "sand/force/surface_patch.hpp"

#include <algorithm>
#include <cmath>

#include "sand/tin/geometry/surface_view.hpp"

namespace sand::force {

namespace {

/// [cell]
int reachOf(double toolRadius, double cell) {
    return static_cast<int>(std::ceil(std::max(4 * toolRadius / cell, 8.0)));
}

}  // namespace

template <class HeightOf>
void SurfacePatch::sample(int columns, int rows, double cell, ProbePoint centre, double toolRadius, HeightOf heightOf) {
    const int reach = reachOf(toolRadius, cell);
    const int stride = (2 * reach + 1 + kMaxSideNodes - 1) / kMaxSideNodes;
    const int half = reach / stride;
    const auto firstCell = [&](std::int32_t coordinate, int cells) {
        const int middle = std::clamp(static_cast<int>(coordinate >> kProbeBits), 0, cells - 1);
        return middle - half * stride;
    };
    const int x0 = firstCell(centre.x, columns);
    const int y0 = firstCell(centre.y, rows);
    columns_ = rows_ = 2 * half + 1;
    spacing_ = stride * cell;
    cutBeyond_ = 0;
    west_ = (x0 + 0.5) * cell;
    south_ = (y0 + 0.5) * cell;
    fieldWidth_ = columns * cell;
    fieldHeight_ = rows * cell;
    const double unit = cell / kUnitsPerCell;  // [scene unit]
    std::size_t node = 0;
    for (int j = 0; j < rows_; ++j) {
        const int row = std::clamp(y0 + j * stride, 0, rows - 1);
        for (int i = 0; i < columns_; ++i) {
            const int column = std::clamp(x0 + i * stride, 0, columns - 1);
            heights_[node++] = static_cast<float>(heightOf(column, row) * unit);
        }
    }
}

SurfacePatch::SurfacePatch(const HeightField& field, ProbePoint centre, double toolRadius) {
    sample(field.columns(), field.rows(), field.cellSize(), centre, toolRadius,
           [&](int column, int row) { return field.height(column, row); });
}

SurfacePatch::SurfacePatch(const tin::SurfaceView& tin, double cellSize, ProbePoint centre, double toolRadius) {
    takeFacets(tin, cellSize, centre, toolRadius);
}

bool SurfacePatch::takeFacets(const tin::SurfaceView& tin, double cellSize, ProbePoint centre, double toolRadius) {
    const double probe = cellSize / kProbePerCell;  // [scene unit]
    if (!facets_.take(tin, centre, reachOf(toolRadius, cellSize) * kProbePerCell, probe)) {
        return false;
    }
    columns_ = rows_ = 0;
    cutBeyond_ = 0.5 * tin.spacing * probe;
    fieldWidth_ = tin.triangles.width * probe;
    fieldHeight_ = tin.triangles.depth * probe;
    return true;
}

void SurfacePatch::take(const Replica& terrain) {
    const double cell = terrain.cellSize(), radius = terrain.toolRadius();
    if (terrain.tinView() == nullptr) {
        const HeightField& field = terrain.field();
        sample(field.columns(), field.rows(), cell, terrain.probe(), radius,
               [&](int column, int row) { return field.height(column, row); });
    } else if (!takeFacets(*terrain.tinView(), cell, terrain.probe(), radius)) {
        const Rules& rules = terrain.rules();
        sample(rules.columns, rules.rows, cell, terrain.probe(), radius, [&](int column, int row) {
            return terrain.surface().height((column + 0.5) * kProbePerCell, (row + 0.5) * kProbePerCell);
        });
    }
}

Dual SurfacePatch::sampledTangent(double x, double y) const {
    const double freeColumn = (x - west_) / spacing_, freeRow = (y - south_) / spacing_;
    const double column = std::clamp(freeColumn, 0.0, columns_ - 1.0);
    const double row = std::clamp(freeRow, 0.0, rows_ - 1.0);
    const int i = std::min(static_cast<int>(column), std::max(columns_ - 2, 0));
    const int j = std::min(static_cast<int>(row), std::max(rows_ - 2, 0));
    const double u = column - i, v = row - j;
    const int right = columns_ > 1 ? 1 : 0, up = rows_ > 1 ? columns_ : 0;
    const float* node = heights_.data() + std::ptrdiff_t{j} * columns_ + i;
    const double a = node[0], b = node[right], c = node[up], d = node[up + right];
    const double east = (1 - v) * (b - a) + v * (d - c), north = (1 - u) * (c - a) + u * (d - b);
    return {(1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d),
            {column == freeColumn ? east / spacing_ : 0, row == freeRow ? north / spacing_ : 0, 0}};
}

}  // namespace sand::force
