// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/tin/layer.hpp"

namespace sand::tin {

struct Settled {
    int sweeps = 0;       // that brought it to rest
    bool atRest = false;  // false: it still moved after `most` sweeps
};

/// Lets the sand come to rest at once, by sweeps of Erosion: for a scene as it is loaded. Sand that nothing sets in
/// motion stays as it is, if it is steeper than the threshold too; where sand slides, it does until the threshold.
/// Volume is exact, and no vertex ends higher than the highest or lower than the lowest was. It ends by itself;
/// `most` bounds how long that takes, for meshes with stars of very different size.
Settled settle(Layer& layer, std::int32_t threshold, std::int32_t startThreshold, int most = 1'000'000);

}  // namespace sand::tin
