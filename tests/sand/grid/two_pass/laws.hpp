// SPDX-License-Identifier: Apache-2.0
// Private to this folder: the laws of the sweeps in two passes.
#pragma once

#include <algorithm>
#include <cmath>

#include "tests/sand/grid/two_pass/kernel.hpp"

namespace two_pass {

/// Scheme G with inertia. The flux of the last sweep continues. A slope above the threshold pushes it; a slope below
/// the threshold brakes it. A flux never runs uphill, and never exceeds the share that all proofs need. The code
/// compares squares of slopes, because a root would cost a quarter of the sweep.
///
/// With a band, a face whose two cells have no sliding sand carries no flux up to the start threshold. Its flux in the
/// last sweep was 0, too.
template <bool kWithBand>
struct Inertial {
    static constexpr bool kBand = kWithBand;

    Inertial(const AxisLaw& law, float momentumNow)
        : threshold(law.threshold * law.threshold),
          startThreshold(law.startThreshold * law.startThreshold),
          limit(law.limit),
          push(law.push),
          along(law.along),
          momentum(momentumNow) {}

    float threshold, startThreshold;  // [unit²]
    float limit, push, along, momentum;

    /// Returns the flux across a face. `sliding` joins the masks of the two cells.
    std::int32_t operator()(std::int32_t difference, float alongSum, std::int32_t last, std::int32_t sliding) const {
        const auto across = static_cast<float>(difference);
        const float mean = along * alongSum;
        // At least the smallest possible slope, because 0 · (threshold / 0) is not a number.
        const float slope = std::max(across * across + mean * mean, 0.0625F);
        const float driven = push * (1.0F - threshold / slope);
        const float most = limit * across;
        const float forth = std::max(most, 0.0F);
        const float back = std::min(most, 0.0F);
        // The flux that continues is limited first. Otherwise a flux that has just reversed would be 0 for one sweep,
        // and a sweep could not skip a face without flux.
        const float kept = std::min(std::max(momentum * static_cast<float>(last), back), forth);
        const auto flux = static_cast<std::int32_t>(std::min(std::max(kept + driven * across, back), forth));
        return kBand ? flux & (sliding | -static_cast<std::int32_t>(slope > startThreshold)) : flux;
    }
};

/// The law without inertia. The slope across the face comes from its two cells. The slope along it is the mean of four
/// differences.
template <bool kWithBand>
struct Isotropic {
    static constexpr bool kBand = kWithBand;
    AxisLaw axis;

    std::int32_t operator()(std::int32_t difference, float along, std::int32_t, std::int32_t sliding) const {
        const auto across = static_cast<float>(difference);
        const float mean = axis.along * along;
        const float slope = std::sqrt(across * across + mean * mean);
        const float share = slope > axis.threshold ? axis.limit * (1.0F - axis.threshold / slope) : 0.0F;
        const auto flux = static_cast<std::int32_t>(share * across);
        return kBand ? flux & (sliding | -static_cast<std::int32_t>(slope > axis.startThreshold)) : flux;
    }
};

}  // namespace two_pass
