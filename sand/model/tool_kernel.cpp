// SPDX-License-Identifier: Apache-2.0
// Compiled once for every x86-64 and once for x86-64-v3, like the sweeps. The version for x86-64-v3 computes four roots
// at a time.
#include "sand/model/tool_kernel.hpp"

#include <algorithm>
#include <cmath>

#include "sand/model/tool_shape.hpp"

namespace sand::SANDWALL_CODE_PATH {

// All numbers except the root are whole numbers below 2^53, and the root is IEEE's. The results therefore equal those
// of TurnedShape::underside().
void undersidesOfSphere(const SphereRow& row, std::int32_t* __restrict undersides) {
    const auto most = static_cast<double>(row.square), centre = static_cast<double>(row.centre);
    const auto first = static_cast<double>(row.first);
    constexpr double kHighest = kMaxHeight;
    for (int i = 0; i < row.count; ++i) {
        const double x = first + kProbePerCell * static_cast<double>(i);
        const double square = most - x * x;
        const double below = std::sqrt(std::max(square, 0.0)) * kUnitsPerProbe;
        const double under = centre - static_cast<double>(static_cast<std::int32_t>(below));
        const auto underside = static_cast<std::int32_t>(std::min(std::max(under, -kHighest), kHighest));
        undersides[i] = square > 0 ? underside : TurnedShape::kFree;
    }
}

std::int64_t sandAbove(const std::int32_t* __restrict undersides, const std::int32_t* __restrict heights, int count) {
    std::int64_t sum = 0;
    for (int i = 0; i < count; ++i) {
        sum += heights[i] - std::min(heights[i], undersides[i]);
    }
    return sum;
}

}  // namespace sand::SANDWALL_CODE_PATH
