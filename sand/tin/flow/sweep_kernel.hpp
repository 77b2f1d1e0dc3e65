// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sand::tin {

// A triangle slides by c = kPush (s − 1)/(s + 1), s = m²/g²: near g as 1 − g/m does, without its root. Sweeps descend
// the energy whose derivative is m c, and a descent neither overshoots nor swings while step times curvature is at most
// 2: Σ k ≤ star allows 1, and m c bends by at most 1.25 kPush. With 1 − g²/m² and 0.9, of curvature 1.8, sand swings.
inline constexpr double kPush = 0.8;
// Of the bound, what flows with momentum at most: near it a chequerboard swings without damping. A grid's 0.46 of 0.5.
inline constexpr double kMostOfBound = 0.92;
// Sand stays where its slope is steeper than g by less than a part in 1024: it would creep there for many thousand
// sweeps, at heights that nobody tells apart. As much as the band that scenes have unless they say otherwise.
inline constexpr double kRest = 1 + 1.0 / 512;

/// What a sweep asks of a vertex for each facet at it: side by side, for one load.
struct Level {
    double height = 0;  // [unit]
    double flow = 0;    // what flowed at its edges in the sweep before, in and out
};

// Facets, or edges, of which is known together whether an obstacle is over one.
inline constexpr std::size_t kHeldTogether = 16;

/// How strongly facets slide (weights.hpp), each kind of number in an array of its own; corners by their place in the
/// arrays of vertices. Nothing overlaps.
struct SweepFacets {
    std::size_t facets;
    const Level* levels;                            // by vertex
    const double* undersides;                       // by vertex [unit]
    const std::uint8_t* held;                       // by kHeldTogether: an obstacle is over some; null without one
    const std::int32_t *first, *second, *third;     // by facet: its corners
    const double *squared, *mixed, *squaredAcross;  // by facet: Facet's first, mixed, second
    const double* start;  // by facet: the steepness from which on it slides where nothing flows; null: kRest as ever
    const std::uint64_t* bare;  // by facet: all bits, or none
    double* sliding;            // by facet: how strongly it slides, to kPush, or brakes, from -kPush; written
    std::int32_t* slidBare;     // those that slide and are bare, in order; written
};

/// What flows over edges: ends and facets by their place in those arrays.
struct SweepEdges {
    std::size_t edges;
    const Level* levels;                           // by vertex
    const double* undersides;                      // by vertex [unit]
    const std::uint8_t* held;                      // by kHeldTogether: an obstacle is over some; null without one
    const double* sliding;                         // by facet
    const std::int32_t *from, *to, *left, *right;  // by edge: ends and facets
    const double *leftWeights, *rightWeights;      // by edge [probe unit²]
    double momentum;                               // what of the last sweep's flux goes on, 0 to 1
    double* fluxes;                                // by edge: volume from `from` to `to`, whole; read and written
};

/// What the fluxes make of the sand: volumes, whole numbers below 2^53 as all their sums are, and heights.
struct SweepSand {
    std::size_t vertices, edges;
    const std::int32_t *from, *to;   // by edge
    const double* fluxes;            // by edge
    const double* stars;             // by vertex [probe unit²]
    const std::uint64_t* unwatched;  // by vertex: all bits, or none
    std::size_t rimVertices;
    const std::int32_t* rim;  // vertices on an open rim: what lies above height 0 there falls over it
    double* inflow;           // two by vertex: what came less what went, and both together; written
    double* volumes;          // by vertex
    Level* levels;            // by vertex
};

/// What a corner counts as for the slope: sand that fills the room below an obstacle leans on it, and is no slope for
/// the sand beside it, which would flow along it for ever.
inline double leaning(double height, double underside, double one, double other) {
    const double beside = one < other ? one : other;
    return height > underside - 1 && beside > height ? beside : height;
}

struct SweepResult {
    bool moved = false;        // some volume changed
    bool spread = false;       // that of one that is not watched did
    bool met = false;          // sand flowed at an edge of one that is not watched
    std::int64_t resting = 0;  // vertices at whose edges none flowed
    std::int64_t outflow = 0;  // volume that fell over an open rim
};

// One source, compiled twice (sand/tin/CMakeLists.txt): the same numbers, bit for bit.
namespace baseline {
std::size_t slideFacets(const SweepFacets& sweep);  // returns how many slidBare are
void flowOverEdges(const SweepEdges& sweep);
SweepResult moveSand(const SweepSand& sand);
}  // namespace baseline
namespace v3 {
std::size_t slideFacets(const SweepFacets& sweep);
void flowOverEdges(const SweepEdges& sweep);
SweepResult moveSand(const SweepSand& sand);
}  // namespace v3

}  // namespace sand::tin
