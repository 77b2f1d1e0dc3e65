// SPDX-License-Identifier: Apache-2.0
#include "scene/import/raster_heights.hpp"

#include <algorithm>

namespace scene {

RasterHeights::RasterHeights(NumberSize size) {
    if (size == NumberSize::doubles) {
        numbers_ = Doubles();
    }
}

void RasterHeights::reserve(std::size_t count) {
    std::visit([count](auto& numbers) { numbers.reserve(count); }, numbers_);
}

void RasterHeights::multiply(double factor, double summand) { changes_.push_back({false, factor, summand}); }

void RasterHeights::divide(double divisor) {
    if (divisor != 1) {  // a division by 1 would only take time
        changes_.push_back({true, divisor, 0});
    }
}

void RasterHeights::turnOver(int columns) {
    std::visit(
        [columns](auto& numbers) {
            auto north = numbers.begin();
            for (auto south = numbers.end() - columns; north < south; north += columns, south -= columns) {
                std::swap_ranges(north, north + columns, south);
            }
        },
        numbers_);
}

void RasterHeights::keepPart(int columns, const sand::CellRect& part) {
    std::visit(
        [&](auto& numbers) {
            auto to = numbers.begin();
            for (int row = part.y0; row < part.y1; ++row) {
                const auto from = numbers.begin() + std::ptrdiff_t{row} * columns;
                // Numbers only move forward, to places that have been copied before.
                to = from + part.x0 == to ? to + (part.x1 - part.x0) : std::copy(from + part.x0, from + part.x1, to);
            }
            numbers.erase(to, numbers.end());
        },
        numbers_);
}

bool operator==(const RasterHeights& a, const RasterHeights& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

}  // namespace scene
