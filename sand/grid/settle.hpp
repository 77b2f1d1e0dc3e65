// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/grid/erosion.hpp"
#include "sand/grid/net_flux.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

struct Settled {
    int iterations = 0;        // of the dual projection on the field's own cells; 0: sweeps alone did the work
    int sweeps = 0;            // that brought it to rest
    std::int64_t outflow = 0;  // over an open rim [unit · cell]
};

/// Lets the sand come to rest at once: a projection that needs O(side) iterations (dual_projection.hpp), then sweeps
/// of the rules' scheme until nothing moves. For a scene as it is loaded, and as the reference of error figures; how
/// it got there is no picture of sand.
///
/// Volume is exact, and no cell ends higher than the highest or lower than the lowest was. A field at rest is left
/// alone, one that is at rest only thanks to a start threshold above the threshold too; any other settles to the
/// threshold. A field that lies below 0 anywhere under an open rim, or whose projection would leave the extremes, is
/// swept only: that ends too, but takes O(side²) sweeps. It knows neither bedrock nor walls. The result depends on
/// nothing but the arguments, and not on `path`. Memory: 75 bytes per cell of the box in which sand moves. Where `flux`
/// is not null, what passed every face is added to it.
Settled settle(HeightField& field, const Rules& rules, NetFlux* flux = nullptr, CodePath path = CodePath::automatic);

}  // namespace sand::grid
