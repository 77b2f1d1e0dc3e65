// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "sand/height_field.hpp"

namespace sand {

inline constexpr int kMaxBlock = 128;  // [cell], side of the largest block a kernel takes

/// One sweep of one block: reads `in`, writes the same cells of `out`. Both point at cell (0,0) of padded rows.
struct BlockSweep {
    const std::int32_t* in;
    std::int32_t* out;
    std::ptrdiff_t stride;  // [cell] from a row to the next
    Rect cells;             // of the block, at most kMaxBlock on a side
    int columns, rows;      // of the field
    std::int32_t threshold, startThreshold;  // [unit]
    bool n4;
    bool openRim;
    /// How much each cell may still rise this sweep [unit], over `cells` grown by one on every side, row by row; null
    /// where no tool is near.
    const std::int32_t* room;
};

/// Returns whether any cell of the block changed. Adds what left over an open rim to `outflow` [unit · cell].
using SweepKernel = bool (*)(const BlockSweep& block, std::int64_t& outflow);

// One source, compiled twice (sand/CMakeLists.txt): the same heights, bit for bit.
namespace baseline {
bool sweepBlock(const BlockSweep& block, std::int64_t& outflow);
}
namespace v3 {
bool sweepBlock(const BlockSweep& block, std::int64_t& outflow);
}

}  // namespace sand
