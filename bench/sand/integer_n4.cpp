// SPDX-License-Identifier: Apache-2.0
// This file is compiled twice, as the sweeps of sand/ are: once for every x86-64 and once for x86-64-v3.
#include "bench/sand/integer_n4.hpp"

namespace bench::SANDWALL_CODE_PATH {
namespace {

/// Computes the fluxes between two parallel runs of cells [unit].
void fluxesBetween(const std::int32_t* __restrict from, const std::int32_t* __restrict to, int count,
                   std::int32_t threshold, std::int32_t startThreshold, std::int32_t* __restrict flux) {
    for (int i = 0; i < count; ++i) {
        const std::int32_t difference = from[i] - to[i];
        const std::int32_t size = difference < 0 ? -difference : difference;
        const std::int32_t amount = size > startThreshold ? (size - threshold + 3) / 4 : 0;
        flux[i] = difference < 0 ? -amount : amount;
    }
}

/// Applies the fluxes to a row of cells. Returns 0 if no sand flowed east or north from it.
std::int32_t addUp(const std::int32_t* __restrict east, const std::int32_t* __restrict south,
                   const std::int32_t* __restrict north, int count, std::int32_t* __restrict heights) {
    std::int32_t moved = 0;
    for (int i = 0; i < count; ++i) {
        heights[i] += east[i - 1] - east[i] + south[i] - north[i];
        moved |= east[i] | north[i];
    }
    return moved;
}

}  // namespace

bool sweep(const IntegerN4Sweep& patch) {
    std::int32_t moved = 0;
    // A row changes after its fluxes to the row north of it are known. That row still has the heights before the sweep.
    for (int y = 0; y < patch.rows; ++y) {
        const std::ptrdiff_t row = y * patch.stride;
        std::int32_t* const heights = patch.heights + row;
        fluxesBetween(heights, heights + 1, patch.columns - 1, patch.threshold, patch.startThreshold, patch.east + row);
        // The northernmost fluxes stay zero, like those over the other rims.
        if (y + 1 < patch.rows) {
            fluxesBetween(heights, heights + patch.stride, patch.columns, patch.threshold, patch.startThreshold,
                          patch.north + row);
        }
        moved |= addUp(patch.east + row, patch.north + row - patch.stride, patch.north + row, patch.columns, heights);
    }
    return moved != 0;
}

}  // namespace bench::SANDWALL_CODE_PATH
