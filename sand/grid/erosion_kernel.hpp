// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sand/model/cell_array.hpp"

namespace sand::grid {

inline constexpr int kMaxBlock = 128;    // [cell], side of the largest block
inline constexpr int kMaxPatch = 512;    // [cell], longest row a kernel takes at once
inline constexpr int kKernelMargin = 8;  // [cell], how far beyond its cells a kernel may read heights

/// Whether sand slid in a cell, which means that some flowed through one of its faces in the last sweep: a mask of
/// ones, or 0. As wide as a height, because g++ compiles a loop with numbers of both widths for 32 cells at once, and
/// patches are often 8 wide.
using Sliding = std::int32_t;

/// The constants of the isotropic law for the faces across one axis (sand/grid/erosion.hpp states the law).
struct AxisLaw {
    float threshold, startThreshold;  // [unit], difference between the two cells of a face
    float limit;                      // share of the difference that a flux may be at most
    float push;                       // how strongly the excess over the threshold drives, with inertia
    float along;                      // from the sum of four differences along the face to their mean, in the same unit
};

/// Fluxes of one sweep through the faces of a patch, which is a rectangle of whole blocks: the faces east and north of
/// each of its cells, and where it meets the field's western or southern rim, the faces there. Patches and not blocks,
/// because rows begin and end with work that cannot be done eight cells at a time.
struct FluxPatch {
    const std::int32_t* heights;  // at the patch's first cell; read up to a cell beyond the patch on every side
    std::ptrdiff_t heightStride;  // [cell]
    std::int32_t* east;           // at cell (0,0) of the field: flux to the eastern neighbour [unit]; of the last
    std::int32_t* north;          // sweep when called, of this one on return
    std::ptrdiff_t fluxStride;    // [cell]
    CellRect cells;               // of the patch, at most kMaxPatch wide
    int columns, rows;            // of the field
    AxisLaw eastLaw, northLaw;
    float momentum;  // share of the last sweep's flux that goes on
    bool inertial;   // with inertia; else the plain law
    bool openRim;
    const Sliding* sliding;        // at cell (0,0) of the field, with a ghost cell on every side; null without a band
    std::ptrdiff_t slidingStride;  // [cell]
    // Over `cells` grown by one on every side, row by row; null where nothing holds the sand:
    const std::int32_t* room;  // what each cell may receive through a face [unit]
    const std::int32_t* sand;  // what lies in each cell [unit]: a face gives at most a quarter
};

/// Where in a block sand flows, over faces that it owns: the eastern and northern ones of its cells. A face changes two
/// heights, and the fluxes of a block come from its heights and those a cell around it: whoever's faces do not flow
/// near a side leaves the block there as it is.
namespace flow {
inline constexpr int kSomewhere = 1;
inline constexpr int kWest = 2, kSouth = 4;   // in its first column or row
inline constexpr int kEast = 8, kNorth = 16;  // in its last two
}  // namespace flow

/// The same patch's heights after these fluxes.
struct BalancePatch {
    std::int32_t* heights;  // at cell (0,0) of the field
    std::ptrdiff_t heightStride;
    const std::int32_t* east;  // as in FluxPatch
    const std::int32_t* north;
    std::ptrdiff_t fluxStride;
    Sliding* sliding;  // at cell (0,0) of the field, of these fluxes; written, null without a band
    std::ptrdiff_t slidingStride;
    CellRect cells;
    int blockSize;        // [cell]
    std::uint8_t* moved;  // of the patch's first block: where in it sand flows, as bits of `flow`; written
    int blocksAcross;     // from a block's `moved` to that of the block north of it
};

// One source, compiled twice (sand/CMakeLists.txt): the same heights, bit for bit. sweepFluxes returns what leaves over
// an open rim [unit · cell]; markSliding does that part of balance() alone.
namespace baseline {
std::int64_t sweepFluxes(const FluxPatch& patch);
void balance(const BalancePatch& patch);
void markSliding(const BalancePatch& patch);
}  // namespace baseline
namespace v3 {
std::int64_t sweepFluxes(const FluxPatch& patch);
void balance(const BalancePatch& patch);
void markSliding(const BalancePatch& patch);
}  // namespace v3

}  // namespace sand::grid
