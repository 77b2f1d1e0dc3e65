// SPDX-License-Identifier: Apache-2.0
#include "sand/model/height_field.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace sand {

namespace {

double checked(int columns, int rows, double cellSize) {
    const bool sides = columns >= 1 && columns <= kMaxSide && rows >= 1 && rows <= kMaxSide;
    if (!sides || !std::isfinite(cellSize) || cellSize <= 0) {
        throw std::invalid_argument("HeightField: sides or cell size out of range");
    }
    return cellSize;
}

}  // namespace

HeightField::HeightField(int columns, int rows, double cellSize)
    : cellSize_(checked(columns, rows, cellSize)), cells_(columns, rows) {}

double HeightField::interpolated(double x, double y) const {
    const double across = std::clamp(x / kProbePerCell, 0.5, columns() - 0.5) - 0.5;
    const double along = std::clamp(y / kProbePerCell, 0.5, rows() - 0.5) - 0.5;
    const int column = static_cast<int>(across), east = std::min(column + 1, columns() - 1);
    const int row = static_cast<int>(along), north = std::min(row + 1, rows() - 1);
    const double u = across - column, v = along - row;
    return (1 - v) * ((1 - u) * height(column, row) + u * height(east, row)) +
           v * ((1 - u) * height(column, north) + u * height(east, north));
}

std::int64_t HeightField::volume() const {
    std::int64_t sum = 0;
    for (int y = 0; y < rows(); ++y) {
        sum = std::accumulate(row(y), row(y) + columns(), sum);
    }
    return sum;
}

bool sameHeights(const HeightField& a, const HeightField& b) {
    if (a.columns() != b.columns() || a.rows() != b.rows()) {
        return false;
    }
    for (int y = 0; y < a.rows(); ++y) {
        if (!std::equal(a.row(y), a.row(y) + a.columns(), b.row(y))) {
            return false;
        }
    }
    return true;
}

}  // namespace sand
