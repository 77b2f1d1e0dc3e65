// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "sand/height_field.hpp"

namespace sand {

inline constexpr int kMaxBlock = 128;  // [cell], side of the largest block
inline constexpr int kMaxPatch = 512;  // [cell], longest row a kernel takes at once

/// One sweep of a patch, which is a rectangle of whole blocks: reads `in`, writes the same cells of `out`. Both point
/// at cell (0,0) of a HeightField, whose padding it reads. Patches and not blocks, because every row begins and ends
/// with work that cannot be done eight cells at a time, and a patch with fluxes that its neighbour computes too.
struct PatchSweep {
    const std::int32_t* in;
    std::int32_t* out;
    std::ptrdiff_t stride;                   // [cell] from a row to the next
    Rect cells;                              // of the patch, at most kMaxPatch wide
    int blockSize;                           // [cell]
    int columns, rows;                       // of the field
    std::int32_t threshold, startThreshold;  // [unit]
    bool n4;
    bool openRim;
    /// How much each cell may still rise this sweep [unit], over `cells` grown by one on every side, row by row; null
    /// where no tool is near.
    const std::int32_t* room;
    std::uint8_t* moved;  // of the patch's first block: whether a cell of it changed
    int blocksAcross;     // from a block's `moved` to that of the block north of it
};

// One source, compiled twice (sand/CMakeLists.txt): the same heights, bit for bit. They add what left over an open rim
// to `outflow` [unit · cell].
namespace baseline {
void sweepPatch(const PatchSweep& patch, std::int64_t& outflow);
}
namespace v3 {
void sweepPatch(const PatchSweep& patch, std::int64_t& outflow);
}

}  // namespace sand
