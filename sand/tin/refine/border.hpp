// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "sand/tin/geometry/holes.hpp"

namespace sand::tin {

/// Cells whose samples are not a number as holes; null when all have data.
[[nodiscard]] std::shared_ptr<const Holes> holesOf(std::span<const double> heights, const Cells& cells);

/// Where the ground of a raster ends: points on the field's rim and on the outline of holes, besides the field's four
/// corners, and the edges between those on an outline.
struct Border {
    std::vector<Place> places;                     // no two alike, no corner of the field among them
    std::vector<double> heights;                   // [the raster's unit]
    std::vector<std::pair<Vertex, Vertex>> edges;  // 0 to 3 are the corners, 4 the first place
};

/// As high as the samples of the ground beside it, or their mean in a corner. Each straight part is made of few points,
/// greedily: until the cells beside it are no higher or lower than it by more than maxError, those of outlines until
/// none is longer than four cells either. Without it the surface between the outermost samples and the rim, half a cell
/// farther, hangs on the field's corners, and is a cliff. No rim where samples lie on it.
///
/// @param longestOnRim  Rim edges are no longer than that, or a cell [probe unit]; 0: as long as maxError lets them.
[[nodiscard]] Border borderOf(std::span<const double> heights, const Cells& cells, const Holes* holes, double maxError,
                              std::int32_t longestOnRim = 0);

}  // namespace sand::tin
