// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/grid/erosion.hpp"
#include "sand/grid/net_flux.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "sand/model/work_limit.hpp"

namespace sand::grid {

/// Result of settle().
struct Settled {
    int iterations = 0;        // iterations of the dual projection on the field's own cells; 0 if only sweeps ran
    int sweeps = 0;            // sweeps after it
    bool atRest = true;        // false if `limit` was reached before all sand was at rest
    std::int64_t outflow = 0;  // volume that left over an open rim [unit · cell]
};

/// Lets the sand come to rest at once. A projection of O(side) iterations (dual_projection.hpp) comes first, then
/// sweeps of the rules' scheme until no sand moves. Scenes use it while they load, and error figures use it as
/// reference. The states in between do not look like sliding sand.
///
/// Volume is exact. No cell ends higher than the highest or lower than the lowest cell of the start. A field at rest
/// does not change, even if it rests only because the start threshold is above the threshold. Any other field settles
/// to the threshold.
///
/// A field with an open rim that has heights below 0, or whose projection would leave the extremes, is only swept. That
/// ends too, but takes O(side²) sweeps. The function knows neither bedrock nor walls. The result does not depend on
/// `path`. The flux through every face is added to `flux` unless that is null. Memory: 75 bytes per cell of the box in
/// which sand moves.
Settled settle(HeightField& field, const Rules& rules, NetFlux* flux = nullptr,
               base::CodePath path = base::fastestCodePath(), WorkLimit* limit = nullptr);

}  // namespace sand::grid
