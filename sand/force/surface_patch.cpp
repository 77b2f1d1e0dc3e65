// SPDX-License-Identifier: Apache-2.0
#include "sand/force/surface_patch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sand/tin/geometry/surface_view.hpp"

namespace sand::force {

namespace {

/// Returns how far a patch reaches from its centre [cell].
int reachOf(double toolRadius, double cell) {
    return static_cast<int>(std::ceil(std::max(4 * toolRadius / cell, 8.0)));
}

/// Returns the distance from a tool's outline to the middle of its cut [scene unit].
double halfCut(const tin::SurfaceView& tin, double cell) { return 0.5 * tin.spacing * probeUnit(cell); }

}  // namespace

template <class HeightOf>
void SurfacePatch::sample(const Cells& cells, ProbePoint probe, double toolRadius, HeightOf heightOf) {
    const int reach = reachOf(toolRadius, cells.size);
    const auto within = [reach](std::int32_t coordinate, int count) {
        const int middle = std::clamp(static_cast<int>(coordinate >> kProbeBits), 0, count - 1);
        return std::pair{std::max(middle - reach, 0), std::min(middle + reach, count - 1)};
    };
    auto [west, east] = within(probe.x, cells.columns);
    auto [south, north] = within(probe.y, cells.rows);
    const int stride = std::max(east - west, north - south) / cells.most + 1;
    west -= west % stride;
    south -= south % stride;
    columns_ = (east - west + stride - 1) / stride + 1;
    rows_ = (north - south + stride - 1) / stride + 1;
    spacing_ = stride * cells.size;
    cutBeyond_ = 0;
    west_ = (west + 0.5) * cells.size;
    south_ = (south + 0.5) * cells.size;
    fieldWidth_ = cells.columns * cells.size;
    fieldHeight_ = cells.rows * cells.size;
    const double unit = cells.size / kUnitsPerCell;  // [scene unit]
    heights_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    std::size_t node = 0;
    for (int j = 0; j < rows_; ++j) {
        const int row = std::min(south + j * stride, cells.rows - 1);
        for (int i = 0; i < columns_; ++i) {
            const int column = std::min(west + i * stride, cells.columns - 1);
            heights_[node++] = static_cast<float>(heightOf(column, row) * unit);
        }
    }
}

SurfacePatch::SurfacePatch(const HeightField& field, ProbePoint probe, double toolRadius) {
    takeCells(field, probe, toolRadius);
}

void SurfacePatch::takeCells(const HeightField& field, ProbePoint probe, double toolRadius) {
    sample({field.columns(), field.rows(), field.cellSize(), kMostCells}, probe, toolRadius,
           [&](int column, int row) { return field.height(column, row); });
}

SurfacePatch::SurfacePatch(const tin::SurfaceView& tin, double cellSize, ProbePoint probe, double toolRadius) {
    takeFacets(tin, cellSize, probe, toolRadius);
}

bool SurfacePatch::takeFacets(const tin::SurfaceView& tin, double cellSize, ProbePoint probe, double toolRadius) {
    const double unit = probeUnit(cellSize);  // [scene unit]
    if (!facets_.take(tin, probe, reachOf(toolRadius, cellSize) * kProbePerCell, unit)) {
        return false;
    }
    columns_ = rows_ = 0;
    cutBeyond_ = halfCut(tin, cellSize);
    fieldWidth_ = tin.triangles.width * unit;
    fieldHeight_ = tin.triangles.depth * unit;
    return true;
}

void SurfacePatch::take(const Surface& surface, const Rules& rules, double cellSize, const ProbePoint& probe) {
    const double radius = rules.tuning.tool.radius * cellSize / kProbePerCell;
    const SurfaceData data = surface.data();
    if (const auto* grid = std::get_if<GridData>(&data)) {
        takeCells(grid->field, probe, radius);
    } else if (const tin::SurfaceView& tin = std::get<TinData>(data).view; !takeFacets(tin, cellSize, probe, radius)) {
        sample({rules.columns, rules.rows, cellSize, kMostHeights}, probe, radius, [&](int column, int row) {
            return surface.height((column + 0.5) * kProbePerCell, (row + 0.5) * kProbePerCell);
        });
        cutBeyond_ = halfCut(tin, cellSize);
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
