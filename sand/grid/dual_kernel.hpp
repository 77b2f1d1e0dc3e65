// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstddef>

namespace sand::grid {

inline constexpr int kDualLanes = 8;  // rows of the dual's arrays are whole vectors of this many numbers
inline constexpr int kDualRows = 8;   // rows of scratch an iteration needs

/// The dual variable of a quad, which is the square between four cell centres: what presses the sand east, north, and
/// against the quad's twist [cell²].
using QuadPressure = std::array<double*, 3>;

/// One iteration of the accelerated dual projection on a box of cells (dual_projection.hpp). All arrays have `stride`
/// numbers from row to row, with a zero before the first and zeros from the last up to a whole vector and one more.
struct DualIteration {
    int columns, rows;                              // [cell], at least 2; quads are one fewer each way
    std::ptrdiff_t stride;                          // from a row to the next
    const double* start;                            // heights [cell]
    QuadPressure now;                               // after the last iteration
    QuadPressure before;                            // after the one before it; this iteration's result replaces it
    double momentum;                                // share of the last change that is carried on
    double step;                                    // of the gradient; at most one over the norm of the slope operator
    double threshold;                               // largest stable difference between neighbours in a row [cell]
    double northing;                                // slope along a column per difference, over that along a row
    double twist;                                   // weight of a quad's twist in its slope
    bool heldWest, heldEast, heldSouth, heldNorth;  // whether the outermost cells keep their height
    double* scratch;                                // kDualRows rows
    /// Sums over each column of quads, added to: of (extrapolated - new) · (new - now), whose sign asks for a restart.
    double* turn;
    /// The same for columns of cells and quads where `measure`: duality gap, squared change of height, greatest excess
    /// of a quad's slope.
    bool measure;
    double *gap, *moved, *excess;
};

// One source, compiled twice (sand/CMakeLists.txt): the same numbers, bit for bit. Sums are taken down each column, in
// the order of rows, which no vectorisation can change.
namespace baseline {
void iterateDual(const DualIteration& iteration);
}
namespace v3 {
void iterateDual(const DualIteration& iteration);
}

}  // namespace sand::grid
