// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/rules.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

struct Settled {
    int iterations = 0;         // of the dual projection; 0: sweeps alone did the work
    int sweeps = 0;             // that brought it to rest
    bool atRest = false;        // false: it still moved after `most` sweeps
    std::int64_t outflow = 0;   // that fell over an open rim [volume unit]; the layer has lost it
    std::vector<Vertex> moved;  // whose volume is another now, ascending
};

/// Lets the sand come to rest at once, as sand::settle does with a grid's: a projection (dual_projection.hpp), then
/// sweeps of Erosion until nothing moves. Sand that nothing sets in motion stays as it is, if it is steeper than the
/// threshold too; any other settles to the threshold.
///
/// Volume is exact, and no vertex ends higher than the highest or lower than the lowest was, the ground at height 0
/// beyond an open rim included: where the projection would leave these, sweeps do all of it. It ends by itself; `most`
/// bounds how long that takes, for meshes with stars of very different size.
Settled settle(VertexSand& layer, std::int32_t threshold, std::int32_t startThreshold, int most = 1'000'000,
               Rim rim = Rim::closed);

}  // namespace sand::tin
