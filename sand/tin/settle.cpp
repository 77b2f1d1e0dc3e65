// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/settle.hpp"

#include <vector>

#include "sand/tin/erosion.hpp"

namespace sand::tin {

Settled settle(Layer& layer, std::int32_t threshold, std::int32_t startThreshold, int most) {
    Erosion erosion(layer, threshold, startThreshold);
    std::vector<Vertex> moved;
    Settled result;
    result.sweeps = erosion.settle(layer, most, moved);
    result.atRest = erosion.settled();
    return result;
}

}  // namespace sand::tin
