// SPDX-License-Identifier: Apache-2.0
// The kernel of the sweeps as it was before it walked over the rows. One pass computes all fluxes of a patch. A second
// one applies them. It shares no loop and no law with sand/grid. The walk must give the
// same heights bit for bit (walk_test.cpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include "sand/model/cell_array.hpp"

namespace two_pass {

using sand::CellRect;

inline constexpr int kMaxPatch = 512;    // [cell], longest row that the kernel handles at once
inline constexpr int kKernelMargin = 8;  // [cell], margin of the kernel's buffers

/// Mask of ones if sand slid in a cell, or 0 if it did not. Sand slid in a cell if some flowed through one of its faces
/// in the last sweep.
using Sliding = std::int32_t;

/// Constants of the isotropic law for the faces across one axis. sand/grid/erosion.hpp states the law.
struct AxisLaw {
    float threshold, startThreshold;  // difference between the two cells of a face [unit]
    float limit;                      // largest flux, as a share of the difference
    float push;                       // factor of the excess over the threshold, with inertia
    float along;  // factor from the sum of four differences along the face to their mean, in the unit across it
};

/// Fluxes of one sweep through the faces of a patch. A patch is a rectangle of whole blocks. Its faces are the eastern
/// and northern faces of its cells, and the faces at the field's western or southern rim if it lies there. A kernel
/// handles a whole patch at once, because the ends of a row need work that cannot be done eight cells at a time.
struct FluxPatch {
    const std::int32_t* heights;  // at the patch's first cell; read up to one cell beyond the patch on every side
    std::ptrdiff_t heightStride;  // [cell]
    std::int32_t* east;           // at cell (0,0) of the field: flux to the eastern neighbour [unit]
    std::int32_t* north;  // flux to the northern neighbour [unit]; the last sweep's before the call, then this sweep's
    std::ptrdiff_t fluxStride;  // [cell]
    CellRect cells;             // cells of the patch, at most kMaxPatch wide
    int columns, rows;          // size of the field [cell]
    AxisLaw eastLaw, northLaw;
    float momentum;  // share of the last sweep's flux that continues
    bool inertial;   // whether the law has inertia; false for plain G
    bool openRim;
    const Sliding* sliding;        // at cell (0,0) of the field, with ghost cells around; null without a band
    std::ptrdiff_t slidingStride;  // [cell]
    // Limits over `cells` and one more cell on every side, row by row; null without limits.
    const std::int32_t* room;  // what each cell may receive [unit]; a face brings at most a quarter
    const std::int32_t* sand;  // thickness of the sand in each cell [unit]; a face gives at most a quarter
};

/// Change of a patch's heights by the fluxes of a sweep.
struct BalancePatch {
    std::int32_t* heights;  // at cell (0,0) of the field [unit]
    std::ptrdiff_t heightStride;
    const std::int32_t* east;  // fluxes at cell (0,0) of the field [unit], see FluxPatch
    const std::int32_t* north;
    std::ptrdiff_t fluxStride;
    Sliding* sliding;  // at cell (0,0) of the field; receives where these fluxes slid; null without a band
    std::ptrdiff_t slidingStride;
    CellRect cells;
};

/// Computes the fluxes of a patch. Returns the outflow over an open rim [unit · cell].
std::int64_t sweepFluxes(const FluxPatch& patch);
/// Applies the fluxes of a patch to its heights. Returns whether sand flowed in it.
bool balance(const BalancePatch& patch);

}  // namespace two_pass
