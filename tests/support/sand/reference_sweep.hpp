// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "sand/grid/net_flux.hpp"
#include "sand/model/height_field.hpp"

/// Plain sweeps, cell by cell, that count the sand through every face. Fast sweeps are compared with them.
namespace reference {

/// Returns the height difference between a cell's northern and southern neighbours, or its eastern and western ones.
/// Beyond the rim the slope of the ground continues.
inline double alongColumn(const sand::HeightField& field, int x, int y) {
    const auto height = [&](int row) { return static_cast<double>(field.height(x, row)); };
    const int last = field.rows() - 1;
    const double above = y < last ? height(y + 1) : 2 * height(last) - height(std::max(last - 1, 0));
    const double below = y > 0 ? height(y - 1) : 2 * height(0) - height(std::min(1, last));
    return above - below;
}
inline double alongRow(const sand::HeightField& field, int x, int y) {
    const auto height = [&](int column) { return static_cast<double>(field.height(column, y)); };
    const int last = field.columns() - 1;
    const double east = x < last ? height(x + 1) : 2 * height(last) - height(std::max(last - 1, 0));
    const double west = x > 0 ? height(x - 1) : 2 * height(0) - height(std::min(1, last));
    return east - west;
}

/// The isotropic law without inertia (sand/grid/erosion.hpp).
struct Isotropic {
    std::int64_t operator()(double across, double along, double threshold) const {
        const double slope = std::sqrt(across * across + along * along / 16);
        return slope > threshold ? static_cast<std::int64_t>(0.2499 * (1 - threshold / slope) * across) : 0;
    }
};

/// A rule that looks at each pair of neighbours alone. No scheme of ours uses it: its sand rests in the wrong pile,
/// which the oracles must detect.
struct FourNeighbours {
    std::int64_t operator()(double across, double, double threshold) const {
        const double flux = std::ceil(std::max(std::abs(across) - threshold, 0.0) / 4);
        return static_cast<std::int64_t>(across < 0 ? -flux : flux);
    }
};

/// Sweeps a closed field of square cells until no sand moves. Returns the sum of all sand that has passed its faces.
template <class Law>
sand::grid::NetFlux relax(sand::HeightField& field, std::int32_t threshold, Law law) {
    sand::grid::NetFlux total(field.columns(), field.rows());
    for (bool moved = true; moved;) {
        moved = false;
        sand::grid::NetFlux now(field.columns(), field.rows());
        for (int y = 0; y < field.rows(); ++y) {
            for (int x = 0; x < field.columns(); ++x) {
                const double here = field.height(x, y);
                if (x + 1 < field.columns()) {
                    now.east(y)[x] = law(here - field.height(x + 1, y),
                                         alongColumn(field, x, y) + alongColumn(field, x + 1, y), threshold);
                    moved = moved || now.east(y)[x] != 0;
                }
                if (y + 1 < field.rows()) {
                    now.north(y)[x] = law(here - field.height(x, y + 1),
                                          alongRow(field, x, y) + alongRow(field, x, y + 1), threshold);
                    moved = moved || now.north(y)[x] != 0;
                }
            }
        }
        for (int y = 0; y < field.rows(); ++y) {
            for (int x = 0; x < field.columns(); ++x) {
                field.setHeight(x, y, static_cast<std::int32_t>(field.height(x, y) + now.rise(x, y)));
            }
        }
        total.add(now);
    }
    return total;
}

}  // namespace reference
