// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstddef>

namespace sand::grid {

inline constexpr int kDualLanes = 8;  // numbers per vector; rows of the arrays are whole vectors
inline constexpr int kDualRows = 8;   // rows of scratch memory that an iteration needs

/// Dual variable of the quads: the pressure on the sand to the east, to the north, and against the quad's twist
/// [cell²]. A quad is the square between four cell centres.
using QuadPressure = std::array<double*, 3>;

/// One iteration of the accelerated dual projection on a box of cells (dual_projection.hpp).
///
/// The rows of all arrays are `stride` numbers apart. A zero precedes the first number of a row. Zeros follow its last
/// number up to a whole vector, and one more zero follows them.
struct DualIteration {
    int columns, rows;      // size of the box [cell], at least 2; there is one quad fewer each way
    std::ptrdiff_t stride;  // distance from one row to the next
    const double* start;    // heights [cell]
    QuadPressure now;       // pressure after the last iteration
    QuadPressure before;    // pressure after the iteration before it; this iteration's result replaces it
    double momentum;        // share of the last change that continues
    double step;            // length of a gradient step; at most 1 / norm of the slope operator
    double threshold;       // largest stable difference between neighbours in a row [cell]
    double northing;        // slope along a column per difference, divided by slope along a row per difference
    double twist;           // weight of a quad's twist in its slope
    bool heldWest, heldEast, heldSouth, heldNorth;  // whether the outermost cells keep their height
    double* scratch;                                // scratch memory of kDualRows rows
    /// Receives, added up over each column of quads, (extrapolated - new) · (new - now). The sign of the sum shows
    /// whether the momentum must be reset.
    double* turn;
    /// Measures of each column of cells or quads, computed if `measure` is true: duality gap, squared change of height,
    /// and greatest excess of a quad's slope.
    bool measure;
    double *gap, *moved, *excess;
};

// This function is compiled twice from one source (sand/CMakeLists.txt). Both versions return the same numbers bit for
// bit. Sums run down each column in the order of rows, so that vectorisation cannot change them.
namespace baseline {
void iterateDual(const DualIteration& iteration);
}
#if defined(__wasm__)
namespace v3 = baseline;  // one version, for WebAssembly
#else
namespace v3 {
void iterateDual(const DualIteration& iteration);
}
#endif

}  // namespace sand::grid
