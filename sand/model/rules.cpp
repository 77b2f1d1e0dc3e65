// SPDX-License-Identifier: Apache-2.0
#include "sand/model/rules.hpp"

#include <xxhash.h>

#include <algorithm>

namespace sand {
namespace {

constexpr std::int64_t kMostCells = std::int64_t{1} << 30;  // below the tool, summed over the sub-steps of one step

}  // namespace

std::uint64_t Rules::digest() const {
    const base::Bytes bytes = base::encoded(*this);
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), kAlgorithmVersion);
}

StepLimits Rules::stepLimits() const { return tin == 0 ? StepLimits{} : StepLimits{0, 0, kMostSubstepsOfTin}; }

std::int64_t Rules::mostSubsteps() const {
    const std::int64_t side = 2 * std::int64_t{tuning.tool.radius / kProbePerCell} + 2;  // [cell], with any heading
    const std::int64_t cells = std::min<std::int64_t>(side, columns) * std::min<std::int64_t>(side, rows);
    return std::min(kMostCells / std::max<std::int64_t>(cells, 1), stepLimits().mostSubsteps);
}

}  // namespace sand
