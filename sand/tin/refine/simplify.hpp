// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sand/tin/mesh/mesh.hpp"
#include "sand/tin/refine/border.hpp"

namespace sand::tin {

/// Heights on a lattice, in whatever unit: sample (column, row) lies at first + spacing · (column, row), which
/// need not be alike both ways. Not a number: no data.
struct Raster {
    std::span<const double> heights;  // row by row from the south, columns from the west
    int columns = 0, rows = 0;
    Place first;
    Place spacing{256, 256};  // [probe unit], of columns and of rows

    [[nodiscard]] Place placeOf(std::size_t sample) const {
        const auto width = static_cast<std::size_t>(columns);
        return {first.x + spacing.x * static_cast<std::int32_t>(sample % width),
                first.y + spacing.y * static_cast<std::int32_t>(sample / width)};
    }
};

/// How far to go: until no sample is farther from the surface than maxError, or there are maxVertices.
struct SimplifyGoal {
    double maxError = 0;  // [the raster's unit]
    int maxVertices = 1 << 22;
    bool reports = true;  // the root mean square of the errors that are left; otherwise it is 0, and takes no memory
};

/// Some of a raster's samples, whose triangulation is near to all of them.
struct Simplified {
    std::vector<Place> places;          // the field's corners, those given, then samples as they were chosen
    std::vector<double> heights;        // [the raster's unit]
    double maxError = 0, rmsError = 0;  // vertical, over all samples with data [the raster's unit]
};

/// Greedy insertion (Garland and Heckbert 1995): the Delaunay triangulation of a field of this size starts from its
/// corners, which take the height of the nearest sample with data; then the sample with the largest vertical error is
/// put in, of equals the first in the raster, again and again. Samples without data are never put in and count for
/// nothing: the surface spans them. Memory: a bit a sample, and 8 bytes where errors are reported.
///
/// A function of raster and goal; IEEE sums, products and quotients only. Throws std::invalid_argument for a raster
/// that does not lie in the field, has infinite heights or no data at all, and for fewer vertices than 4.
///
/// @param given  Points that are put in before, and edges that are constrained; they follow the corners. A point on a
///               sample must have that sample's height.
[[nodiscard]] Simplified simplify(std::int32_t width, std::int32_t depth, const Raster& raster,
                                  const SimplifyGoal& goal, const Border& given = {});

/// The vertical errors of the surface through these points, for comparison: as simplify() reports its own.
[[nodiscard]] Simplified measured(std::int32_t width, std::int32_t depth, const Raster& raster,
                                  std::span<const Place> places, std::span<const double> heights);

}  // namespace sand::tin
