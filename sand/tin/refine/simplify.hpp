// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sand/tin/mesh/mesh.hpp"
#include "sand/tin/refine/border.hpp"

namespace sand::tin {

/// Heights on a lattice, in any unit. Sample (column, row) lies at first + spacing · (column, row). The spacing of
/// columns and that of rows may differ. A height that is not a number means no data.
struct Raster {
    std::span<const double> heights;  // row by row from the south, columns from the west
    int columns = 0, rows = 0;
    LatticePoint first;
    LatticePoint spacing{256, 256};  // of columns and of rows [probe unit]

    [[nodiscard]] LatticePoint placeOf(std::size_t sample) const {
        const auto width = static_cast<std::size_t>(columns);
        return {first.x + spacing.x * static_cast<std::int32_t>(sample % width),
                first.y + spacing.y * static_cast<std::int32_t>(sample / width)};
    }
};

/// When to stop: if no sample is farther from the surface than maxError, or if there are maxVertices.
struct SimplifyGoal {
    double maxError = 0;  // [the raster's unit]
    int maxVertices = 1 << 22;
    bool reports = true;  // whether to compute rmsError, which takes 8 bytes per sample; otherwise it is 0
};

/// A choice of a raster's samples whose triangulation is close to all samples.
struct Simplified {
    std::vector<LatticePoint> places;   // the field's corners, the given points, then samples as they were chosen
    std::vector<double> heights;        // [the raster's unit]
    double maxError = 0, rmsError = 0;  // vertical, over all samples with data [the raster's unit]
};

/// Chooses samples by greedy insertion (Garland and Heckbert 1995). The Delaunay triangulation of a `width` × `depth`
/// field starts with its corners. They take the height of the nearest sample with data. Then the sample with the
/// largest vertical error is inserted, again and again. If errors are equal, the first in the raster counts. Samples
/// without data are never inserted and have no error; the surface spans them.
///
/// Memory: one bit per sample, and 8 bytes per sample if errors are reported.
///
/// The result depends only on the arguments. It uses only IEEE operations. Throws std::invalid_argument if the raster
/// does not lie in the field, has infinite heights or has no data, or if goal.maxVertices is less than 4.
///
/// @param given  Points that are inserted after the corners and before all samples, and edges that are constrained.
///               A point at a sample must have the height of that sample.
/// @param done   Called now and then with the vertices as a part of goal.maxVertices, 0 to 1. It may be empty, and has
///               no effect on the result.
[[nodiscard]] Simplified simplify(std::int32_t width, std::int32_t depth, const Raster& raster,
                                  const SimplifyGoal& goal, const Border& given = {},
                                  const std::function<void(double share)>& done = {});

/// Returns the surface through these points with its vertical errors, as simplify() reports them, for comparison.
[[nodiscard]] Simplified measured(std::int32_t width, std::int32_t depth, const Raster& raster,
                                  std::span<const LatticePoint> places, std::span<const double> heights);

}  // namespace sand::tin
