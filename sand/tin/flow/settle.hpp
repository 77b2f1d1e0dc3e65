// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/rules.hpp"
#include "sand/model/work_limit.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// Result of settle().
struct Settled {
    int iterations = 0;         // of the dual projection; 0: sweeps alone did the work
    int sweeps = 0;             // that brought the sand to rest
    bool atRest = false;        // false: sand still moved after `most` sweeps, or when `limit` was reached
    std::int64_t outflow = 0;   // volume that fell over an open rim [volume unit]; the layer has lost it
    std::vector<Vertex> moved;  // vertices whose volume has changed, ascending
};

/// Lets all sand come to rest at once, as sand::settle does on a grid. Uses a projection (dual_projection.hpp), then
/// sweeps of Erosion until all sand is at rest. If no sand moves at first, all sand stays, even where it is steeper
/// than the threshold. Otherwise all sand settles to the threshold.
///
/// Volume is exact. No vertex ends higher than the highest or lower than the lowest was before. With an open rim, the
/// ground at height 0 beyond it counts as well. If the projection would exceed these extremes, sweeps do all of the
/// work.
///
/// The sweeps end by themselves. `most` limits their number on meshes whose stars differ much in size. `limit` bounds
/// the work of iterations and sweeps, and may be null. If it is reached, the sand is that of the work until then, and
/// the layer records which sand moves.
Settled settle(VertexSand& layer, std::int32_t threshold, std::int32_t startThreshold, int most = 1'000'000,
               Rim rim = Rim::closed, WorkLimit* limit = nullptr);

/// Returns the work of a sweep over all of the layer, or of an iteration [cell of a grid, in a sweep].
[[nodiscard]] std::int64_t workOfSweep(const VertexSand& layer);

}  // namespace sand::tin
