// SPDX-License-Identifier: Apache-2.0
// Compiled once for every x86-64 and once for x86-64-v3, with -O3, as the sweeps of a grid are.
#include "sand/tin/sweep_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sand::tin::SANDWALL_CODE_PATH {
namespace {

template <bool kHeld, bool kBand>
void slide(std::size_t count, const double* __restrict heights, const double* __restrict undersides,
           const std::int32_t* __restrict first, const std::int32_t* __restrict second,
           const std::int32_t* __restrict third, const double* __restrict squared, const double* __restrict mixed,
           const double* __restrict squaredAcross, const double* __restrict start, const double* __restrict flows,
           double* __restrict sliding) {
    for (std::size_t i = 0; i < count; ++i) {
        double a = heights[first[i]], b = heights[second[i]], c = heights[third[i]];
        if constexpr (kHeld) {
            const double wasA = a, wasB = b, wasC = c;
            a = leaning(wasA, undersides[first[i]], wasB, wasC);
            b = leaning(wasB, undersides[second[i]], wasC, wasA);
            c = leaning(wasC, undersides[third[i]], wasA, wasB);
        }
        const double d1 = b - a, d2 = c - a;
        const double steepness = squared[i] * d1 * d1 + (mixed[i] * d1 + squaredAcross[i] * d2) * d2;
        const double push = kPush - 2 * kPush / (steepness + 1);
        double rest = kRest;
        if constexpr (kBand) {
            rest = flows[first[i]] + flows[second[i]] + flows[third[i]] > 0 ? kRest : start[i];
        }
        sliding[i] = steepness > rest ? push : 0.0;
    }
}

template <bool kHeld>
void flow(std::size_t count, const double* __restrict heights, const double* __restrict undersides,
          const std::int32_t* __restrict from, const std::int32_t* __restrict to, const std::int32_t* __restrict left,
          const std::int32_t* __restrict right, const double* __restrict leftWeights,
          const double* __restrict rightWeights, const double* __restrict sliding, double* __restrict fluxes) {
    for (std::size_t i = 0; i < count; ++i) {
        const double share = leftWeights[i] * sliding[left[i]] + rightWeights[i] * sliding[right[i]];
        const double one = heights[from[i]], other = heights[to[i]];
        double flux = std::trunc((share > 0 ? share : 0.0) * (one - other));
        if constexpr (kHeld) {
            const double most = std::max(leftWeights[i], 0.0) + std::max(rightWeights[i], 0.0);
            const double overOne = undersides[from[i]], overOther = undersides[to[i]];
            const double above = (one > other ? overOther : overOne) - (one > other ? other : one);
            const double room = std::trunc(most * std::max(above, 0.0));
            flux = std::max(std::min(flux, room), -room);
        }
        fluxes[i] = flux;
    }
}

// Added with one instruction, as an edge's flux and its size are: to know where sand flows costs next to nothing.
using Pair [[gnu::vector_size(2 * sizeof(double)), gnu::aligned(sizeof(double)), gnu::may_alias]] = double;

void sumUp(std::size_t edges, const std::int32_t* from, const std::int32_t* to, const double* fluxes, double* sums) {
    auto* pairs = reinterpret_cast<Pair*>(sums);
    const auto add = [&](std::size_t i) {
        const double flux = fluxes[i], size = std::abs(flux);
        pairs[from[i]] += Pair{-flux, size};
        pairs[to[i]] += Pair{flux, size};
    };
    // Edges that follow each other share a vertex, whose sum would have to be there first: four far apart do not wait.
    // Sums of whole numbers need no order.
    const std::size_t part = edges / 4;
    for (std::size_t i = 0; i < part; ++i) {
        add(i);
        add(i + part);
        add(i + 2 * part);
        add(i + 3 * part);
    }
    for (std::size_t i = 4 * part; i < edges; ++i) {
        add(i);
    }
}

/// A height is a quotient, rounded once.
SweepResult settleUp(std::size_t count, const double* __restrict sums, const double* __restrict stars,
                     const std::uint64_t* __restrict unwatched, double* __restrict volumes, double* __restrict heights,
                     double* __restrict flows) {
    std::uint64_t moved = 0, beyond = 0, met = 0;
    std::int64_t resting = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double inflow = sums[2 * i], flow = sums[2 * i + 1];
        const auto bits = std::bit_cast<std::uint64_t>(inflow + 0.0);  // minus zero is none either
        moved |= bits;
        beyond |= bits & unwatched[i];
        met |= std::bit_cast<std::uint64_t>(flow) & unwatched[i];
        resting += flow > 0 ? 0 : 1;
        flows[i] = flow;
        volumes[i] += inflow;
        heights[i] = volumes[i] / stars[i];
    }
    return {moved != 0, beyond != 0, met != 0, resting};
}

}  // namespace

void sweepFluxes(const SweepFluxes& s) {
    const auto slideAs = [&s](const auto& law) {
        law(s.facets, s.heights, s.undersides, s.first, s.second, s.third, s.squared, s.mixed, s.squaredAcross, s.start,
            s.flows, s.sliding);
    };
    if (s.undersides != nullptr) {
        s.start != nullptr ? slideAs(slide<true, true>) : slideAs(slide<true, false>);
        flow<true>(s.edges, s.heights, s.undersides, s.from, s.to, s.left, s.right, s.leftWeights, s.rightWeights,
                   s.sliding, s.fluxes);
    } else {
        s.start != nullptr ? slideAs(slide<false, true>) : slideAs(slide<false, false>);
        flow<false>(s.edges, s.heights, s.undersides, s.from, s.to, s.left, s.right, s.leftWeights, s.rightWeights,
                    s.sliding, s.fluxes);
    }
}

SweepResult moveSand(const SweepSand& sand) {
    std::fill(sand.inflow, sand.inflow + 2 * sand.vertices, 0.0);
    sumUp(sand.edges, sand.from, sand.to, sand.fluxes, sand.inflow);
    return settleUp(sand.vertices, sand.inflow, sand.stars, sand.unwatched, sand.volumes, sand.heights, sand.flows);
}

}  // namespace sand::tin::SANDWALL_CODE_PATH
