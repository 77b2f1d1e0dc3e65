// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "sand/tin/geometry/holes.hpp"

namespace sand::tin {

/// Returns the cells whose samples are not a number as holes, or null if all cells have data.
[[nodiscard]] std::shared_ptr<const Holes> holesOf(std::span<const double> heights, const Cells& cells);

/// The border of a raster's ground. It has points on the field's rim and on the outline of holes, and the edges between
/// the points of an outline. The field's four corners are not among the points.
struct Border {
    std::vector<LatticePoint> places;              // all different
    std::vector<double> heights;                   // [the raster's unit]
    std::vector<std::pair<Vertex, Vertex>> edges;  // vertices 0 to 3 are the corners, 4 is the first place
};

/// Lengths of the longest edges of a border [probe unit]. They are at least a cell.
struct LongestEdges {
    std::int32_t onOutline = 0;  // of holes
    std::int32_t onRim = 0;      // 0: only the heights limit them
};
/// Returns the longest edges of outlines if no other length is asked for: four cells. Sand beside an outline needs
/// small triangles to flow.
[[nodiscard]] inline std::int32_t usualOnOutline(const Cells& cells) {
    return 4 * std::max(cells.spacing.x, cells.spacing.y);
}

/// Returns the border of a raster's ground. A point is as high as the sample of the ground beside it, or as the mean
/// of several samples at a corner.
///
/// Each straight part gets few points, chosen greedily. Points are added until no cell beside the part is more than
/// `maxError` higher or lower than the part. Points are also added until no edge is longer than `longest`.
///
/// The rim is half a cell beyond the outermost samples. Without the border, the surface between them would depend on
/// the heights of the field's corners, and would be a cliff. If samples lie on the rim, the border has no points
/// there.
[[nodiscard]] Border borderOf(std::span<const double> heights, const Cells& cells, const Holes* holes, double maxError,
                              const LongestEdges& longest);

}  // namespace sand::tin
