// SPDX-License-Identifier: Apache-2.0
#include "sand/model/rules.hpp"

#include <xxhash.h>

#include <algorithm>

namespace sand {
namespace {

// Cells below the tool, summed over the sub-steps of one step. A TIN costs more, because the outline goes into the mesh
// and out of it.
constexpr std::int64_t kMostCells = std::int64_t{1} << 27, kMostCellsOfTin = std::int64_t{1} << 25;

}  // namespace

std::uint64_t Rules::digest() const {
    const base::Bytes bytes = base::encoded(*this);
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), kAlgorithmVersion);
}

StepLimits Rules::stepLimits() const {
    if (tin != 0) {
        return {0, 0, kMostSubstepsOfTin};
    }
    StepLimits limits;
    limits.mostSandBytes = std::max(kMaxSandBytes, mostBytesOf(3));
    return limits;
}

std::int64_t Rules::mostBytesOf(int numbers) const {
    // Messages and records state their length in 32 bits, and hold other data beside the sand.
    constexpr std::int64_t kMost = (std::int64_t{1} << 32) - (1 << 26);
    // Numbers that cannot be compressed take a little more than their four bytes. With the ghost cells.
    const std::int64_t cells = (std::int64_t{columns} + 2) * (std::int64_t{rows} + 2);
    return std::min((std::int64_t{numbers} * 4 + 1) * cells + (1 << 20), kMost);
}

std::int64_t Rules::mostSubsteps() const {
    const std::int64_t side = 2 * std::int64_t{tuning.tool.radius / kProbePerCell} + 2;  // [cell], with any heading
    const std::int64_t cells = std::min<std::int64_t>(side, columns) * std::min<std::int64_t>(side, rows);
    const std::int64_t fit = (tin == 0 ? kMostCells : kMostCellsOfTin) / std::max<std::int64_t>(cells, 1);
    return std::clamp<std::int64_t>(fit, 1, stepLimits().mostSubsteps);
}

}  // namespace sand
