// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace sand::tin {

// A triangle slides by c = kPush (s − 1)/(s + 1), where s = m²/g². Near g this behaves like 1 − g/m, but needs no
// root. Sweeps descend the energy whose derivative is m c. A descent neither overshoots nor swings while step times
// curvature is at most 2. Σ k ≤ star allows a step of 1, and the curvature of m c is at most 1.25 kPush. With 1 −
// g²/m² and 0.9, the curvature is 1.8, and sand swings.
inline constexpr double kPush = 0.8;
// Largest c of a triangle, with momentum. Nearer to the bound, a chequerboard of heights swings without
// damping. On a grid, the share is 0.46 of 0.5.
inline constexpr double kMostOfBound = 0.92;
// Steepness at which sand rests: its slope then exceeds g by less than a part in 1024. Without this margin sand would
// creep for many thousand sweeps, with differences of height too small to see. The default band of scenes is as wide.
inline constexpr double kRest = 1 + 1.0 / 512;

/// The numbers that a sweep needs of a vertex for each facet at it. They are adjacent, so that one load reads both.
struct Level {
    double height = 0;  // [unit]
    double flow = 0;    // sum of the sizes of the fluxes at its edges in the last sweep, in and out
};

// Number of facets, or of edges, with a common flag for an obstacle over one of them.
inline constexpr std::size_t kHeldTogether = 16;

/// Arguments of slideFacets(), which computes how strongly facets slide (weights.hpp). Each kind of number has its own
/// array. Corners are indices of the vertices' arrays. No arrays overlap.
struct SweepFacets {
    std::size_t facets;
    const Level* levels;                            // by vertex
    const double* undersides;                       // by vertex [unit]
    const std::uint8_t* held;                       // per kHeldTogether: 1 if an obstacle is over any; null without one
    const std::int32_t *first, *second, *third;     // by facet: its corners
    const double *squared, *mixed, *squaredAcross;  // by facet: first, mixed and second of Facet
    const double* start;  // by facet: steepness at which it starts to slide if no sand flows there; null: always kRest
    const std::uint64_t* bare;  // by facet: all bits set if it lacks edges, else 0
    double momentum;            // share of `slid` that continues, 0 to 1
    const double* slid;         // by facet: `goesOn` of the last sweep
    double* sliding;            // by facet, written: how strongly it slides, 0 to kMostOfBound
    double* goesOn;             // by facet, written: the same, and 0 if no sand flowed there in the last sweep
    std::int32_t* slidBare;     // written: facets that slide and lack edges, in order
};

/// Arguments of flowOverEdges(), which computes the fluxes. Ends and facets are indices of the vertices' and facets'
/// arrays.
struct SweepEdges {
    std::size_t edges;
    const Level* levels;                           // by vertex
    const double* undersides;                      // by vertex [unit]
    const std::uint8_t* held;                      // per kHeldTogether: 1 if an obstacle is over any; null without one
    const double* sliding;                         // by facet
    const std::int32_t *from, *to, *left, *right;  // by edge: ends and facets
    const double *leftWeights, *rightWeights;      // by edge [probe unit²]
    double* fluxes;  // by edge, written: flux from `from` to `to`, a whole number [volume unit]
};

/// Arguments of moveSand(), which applies the fluxes to volumes and heights. Volumes and all their sums are whole
/// numbers below 2^53.
struct SweepSand {
    std::size_t vertices, edges;
    const std::int32_t *from, *to;   // by edge
    const double* fluxes;            // by edge
    const double* stars;             // by vertex [probe unit²]
    const std::uint64_t* unwatched;  // by vertex: all bits set if it is not watched, else 0
    std::size_t rimVertices;
    const std::int32_t* rim;  // vertices on an open rim; all sand above height 0 there falls over it
    double* inflow;           // two per vertex, written: sum of its fluxes, and sum of their sizes
    double* volumes;          // by vertex
    Level* levels;            // by vertex
};

/// Raises the corners of a facet below an obstacle. Sand that fills the room below the obstacle leans on it, so that no
/// sand flows there. Such a corner counts as high as makes the facet flattest. A corner with more room counts that much
/// less, but never less than its own height. Otherwise the sand beside the obstacle would flow along it without end.
/// `squared`, `mixed` and `squaredAcross` are first, mixed and second of the corners' Facet, times any common factor.
///
/// Goes from corner to corner, so that the facet becomes flatter with each.
inline void lean(std::array<double, 3>& heights, const std::array<double, 3>& undersides, double squared, double mixed,
                 double squaredAcross) {
    const auto raise = [&](std::size_t corner, double flattest) {
        double& height = heights[corner];
        const double room = std::max(undersides[corner] - 1 - height, 0.0);
        height = std::max(flattest - room, height);
    };
    raise(0, ((2 * squared + mixed) * heights[1] + (2 * squaredAcross + mixed) * heights[2]) /
                 (2 * (squared + mixed + squaredAcross)));
    raise(1, heights[0] - mixed * (heights[2] - heights[0]) / (2 * squared));
    raise(2, heights[0] - mixed * (heights[1] - heights[0]) / (2 * squaredAcross));
}

/// Result of moveSand().
struct SweepResult {
    bool moved = false;        // a volume changed
    bool met = false;          // sand flowed at an unwatched vertex
    std::int64_t resting = 0;  // number of vertices at which no sand flowed
    std::int64_t outflow = 0;  // volume that fell over an open rim [volume unit]
};

// One source, compiled twice (sand/CMakeLists.txt). Both compilations give the same numbers, bit for bit.
namespace baseline {
std::size_t slideFacets(const SweepFacets& sweep);  // returns the number of slidBare
void flowOverEdges(const SweepEdges& sweep);
SweepResult moveSand(const SweepSand& sand);
}  // namespace baseline
#if defined(__wasm__)
namespace v3 = baseline;  // one version, for WebAssembly
#else
namespace v3 {
std::size_t slideFacets(const SweepFacets& sweep);
void flowOverEdges(const SweepEdges& sweep);
SweepResult moveSand(const SweepSand& sand);
}  // namespace v3
#endif

}  // namespace sand::tin
