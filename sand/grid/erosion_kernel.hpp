// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sand/grid/displacement.hpp"
#include "sand/model/cell_array.hpp"

namespace sand::grid {

inline constexpr int kMaxBlock = 128;  // [cell], side of the largest block
inline constexpr int kVector = 8;      // [cell], of AVX2

/// Mask of ones if sand slid in a cell, or 0 if it did not. Sand slid in a cell if some flowed through one of its faces
/// in the last sweep. The mask is as wide as a height, so that a vector holds as many masks as heights.
using Sliding = std::int32_t;

/// Constants of the isotropic law for the faces across one axis. sand/grid/erosion.hpp states the law.
struct AxisLaw {
    float threshold, startThreshold;  // difference between the two cells of a face [unit]
    float limit;                      // largest flux, as a share of the difference
    float push;                       // factor of the excess over the threshold, with inertia
    float along;  // factor from the sum of four differences along the face to their mean, in the unit across it
};

/// The cells at whose eastern and northern faces a tool limits slopes and fluxes. The field has no ground. A tool that
/// is partly outside the field may have cells there.
struct HeldFaces {
    const Obstacle& obstacle;

    [[nodiscard]] int y0() const { return obstacle.cells.y0 - 1; }
    [[nodiscard]] int y1() const { return obstacle.cells.y1 + 1; }
    /// Returns the cells of a row as whole vectors.
    [[nodiscard]] Obstacle::Columns columns(int y) const {
        if (y < y0() || y >= y1()) {
            return {0, 0};
        }
        const auto [x0, x1] = obstacle.reached[static_cast<std::size_t>(y - y0())];
        return {std::max(x0, 0) / kVector * kVector, (x1 + kVector - 1) / kVector * kVector};
    }
    /// Returns the undersides of a row, from column 0 on; Obstacle::kFree beside the tool [unit].
    [[nodiscard]] const std::int32_t* undersides(int y) const { return obstacle.row(y) - obstacle.cells.x0; }
};

/// Run of active blocks: those of one row of blocks that touch each other. Two runs of a row of blocks have a block at
/// rest between them, which is at least two cells wide. So neither reads a number that the other one writes.
struct Run {
    int x0, x1;  // columns of its cells
    // Limits over its cells and one more cell on every side, row by row; null without ground.
    const std::int32_t* heights;  // [unit], heights before the sweep with walls raised
    const std::int32_t* sand;     // thickness of the sand [unit]; a face gives at most a quarter
    const std::int32_t* room;     // what each cell may receive in the sweep [unit]; a face brings at most a quarter
};

/// Numbers of one cell row that a walk hands on to its next row. Each pointer is at column 0 of a row as long as the
/// field's, with a margin.
struct RowBuffers {
    std::int32_t* old[3];  // heights before the sweep; row y is in old[y % 3] [unit]
    Sliding* sliding[2];   // of an even and an odd row. In a short run the first of nine rows, from south to north.
    std::ptrdiff_t slidingStride;  // between these rows [cell]
    std::int32_t* before;          // last sweep's fluxes to the north of the row below the run; 0 where no run is below
    std::int32_t* flowed[3];       // not 0 where sand flows: in a block's first row, between, and in its last two rows
    Sliding* slidingAtStart;       // of the first cell row of a strip that has a strip below it; 0 outside its runs
};

/// One sweep over a field. Pointers are at cell (0,0).
struct Sweep {
    std::int32_t* heights;        // [unit]
    std::ptrdiff_t heightStride;  // [cell]
    std::int32_t* east;           // flux to the eastern neighbour [unit]: the last sweep's before, then this sweep's
    std::int32_t* north;          // flux to the northern neighbour [unit]
    std::ptrdiff_t fluxStride;    // [cell]
    int columns, rows;            // size of the field [cell]
    int blockSize;                // [cell]
    AxisLaw eastLaw, northLaw;
    float momentum;  // share of the last sweep's flux that continues
    bool inertial;   // whether the law has inertia; false for plain G
    bool band;       // whether sand starts to slide beyond a higher threshold than the one at which it stops
    bool openRim;
    const HeldFaces* held;        // null without a tool, and with ground
    std::uint8_t* flowed;         // bits of `flow` of block (0,0)
    std::ptrdiff_t flowedStride;  // [block]
};

/// Row of blocks with its active runs, in cells.
struct BlockRow {
    int y0, y1;                  // cell rows of these blocks
    std::span<const Run> runs;   // from west to east
    std::span<const Run> below;  // of the row of blocks below, if this walk sweeps it and has not balanced its last row
    bool keepsFirst;             // whether row y0 keeps its old heights, because a strip below reads them
    // Masks of sliding cells that other strips would overwrite; null if the walk makes them itself.
    const Sliding* slidingFirst;  // of row y0
    const Sliding* slidingAbove;  // of row y1
};

// These functions are compiled once per code path (sand/CMakeLists.txt). All versions return the same heights bit for
// bit.
//
// A sweep walks over the rows of blocks from south to north. walk() sweeps one of them. It computes the fluxes of its
// first cell row, and balances the last cell row of the runs below. Then it computes and balances the other cell rows.
// So a cell row keeps its old heights until all fluxes that depend on them are known. The last cell row stays for the
// next row of blocks; if that one has no runs, call balance(). Returns the outflow over an open rim [unit · cell].
//
// balance() applies the fluxes of one cell row to its heights. With buffers, also clears what they hold of the last row
// of these runs. markSliding() writes where sand slid in one cell row before the sweep.
#define SANDWALL_DECLARE_KERNEL(path)                                                              \
    namespace path {                                                                               \
    std::int64_t walk(const Sweep& sweep, const RowBuffers& buffers, const BlockRow& row);         \
    void balance(const Sweep& sweep, const RowBuffers* buffers, std::span<const Run> runs, int y); \
    void markSliding(const Sweep& sweep, std::span<const Run> runs, int y, Sliding* sliding);      \
    }
SANDWALL_DECLARE_KERNEL(baseline)
#if defined(__wasm__)
namespace v3 = baseline;  // one version, for WebAssembly
namespace v4 = baseline;
#else
SANDWALL_DECLARE_KERNEL(v3)
SANDWALL_DECLARE_KERNEL(v4)
#endif
#undef SANDWALL_DECLARE_KERNEL

}  // namespace sand::grid
