// SPDX-License-Identifier: Apache-2.0
// Compiled once for every x86-64 and once for x86-64-v3, with -O3, like the sweeps of a grid.
#include "sand/tin/flow/sweep_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace sand::tin::SANDWALL_CODE_PATH {
namespace {

using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
using Two [[gnu::vector_size(2 * sizeof(double)), gnu::aligned(sizeof(double)), gnu::may_alias]] = double;

/// Values at one corner of four facets, or of one facet. They are read in pairs, which compilers do not do by
/// themselves.
template <class Number>
struct Corner {
    Number height, flow;
};
template <class Number>
Corner<Number> cornerOf(const Level* levels, const std::int32_t* corner);
template <>
Corner<double> cornerOf<double>(const Level* levels, const std::int32_t* corner) {
    return {levels[*corner].height, levels[*corner].flow};
}
template <>
Corner<Four> cornerOf<Four>(const Level* levels, const std::int32_t* corner) {
    const auto* pairs = reinterpret_cast<const Two*>(levels);
    const Four even = __builtin_shufflevector(pairs[corner[0]], pairs[corner[2]], 0, 1, 2, 3);
    const Four odd = __builtin_shufflevector(pairs[corner[1]], pairs[corner[3]], 0, 1, 2, 3);
    return {__builtin_shufflevector(even, odd, 0, 4, 2, 6), __builtin_shufflevector(even, odd, 1, 5, 3, 7)};
}

template <class Number>
Number valuesAt(const double* values, const std::int32_t* index);
template <>
double valuesAt<double>(const double* values, const std::int32_t* index) {
    return values[*index];
}
template <>
Four valuesAt<Four>(const double* values, const std::int32_t* index) {
    return Four{values[index[0]], values[index[1]], values[index[2]], values[index[3]]};
}

template <class Number>
Number valuesFrom(const double* values) {
    Number result;
    std::memcpy(&result, values, sizeof(Number));
    return result;
}

/// Returns the height of a corner that counts, as lean() raises it. The two share no code: if both compilations had a
/// common function, a linker would keep one of them for both.
template <class Number>
Number raised(Number height, Number underside, Number flattest) {
    const Number below = underside - 1 - height, none{};
    const Number room = below > none ? below : none;
    const Number leans = flattest - room;
    return leans > height ? leans : height;
}

using Bits [[gnu::vector_size(4 * sizeof(std::int64_t))]] = std::int64_t;  // as many elements as Four

bool isAny(std::int64_t bits) { return bits != 0; }
bool isAny(const Bits& bits) {
    const auto two = __builtin_shufflevector(bits, bits, 0, 1) | __builtin_shufflevector(bits, bits, 2, 3);
    return (two[0] | two[1]) != 0;
}

/// Computes the facets from `i` on, as many as Number has elements. Returns whether one of them slides and lacks
/// edges.
template <bool kHeld, bool kBand, class Number, class Mask>
[[gnu::always_inline]] inline bool slide(const SweepFacets& s, std::size_t i) {
    const auto [a, aFlow] = cornerOf<Number>(s.levels, s.first + i);
    const auto [b, bFlow] = cornerOf<Number>(s.levels, s.second + i);
    const auto [c, cFlow] = cornerOf<Number>(s.levels, s.third + i);
    const Number squared = valuesFrom<Number>(s.squared + i), mixed = valuesFrom<Number>(s.mixed + i);
    const Number across = valuesFrom<Number>(s.squaredAcross + i);
    Number atA = a, atB = b, atC = c;
    if constexpr (kHeld) {
        const Number flattest =
            ((2 * squared + mixed) * b + (2 * across + mixed) * c) / (2 * (squared + mixed + across));
        atA = raised(a, valuesAt<Number>(s.undersides, s.first + i), flattest);
        atB = raised(b, valuesAt<Number>(s.undersides, s.second + i), atA - mixed * (c - atA) / (2 * squared));
        atC = raised(c, valuesAt<Number>(s.undersides, s.third + i), atA - mixed * (atB - atA) / (2 * across));
    }
    const Number d1 = atB - atA, d2 = atC - atA;
    const Number steepness = squared * d1 * d1 + (mixed * d1 + across * d2) * d2;
    const Number push = kPush - 2 * kPush / (steepness + 1);
    const Number none{}, flowed = aFlow + bFlow + cFlow;
    Number rest = none + kRest;
    if constexpr (kBand) {
        rest = flowed > none ? rest : valuesFrom<Number>(s.start + i);
    }
    // A facet that is flatter than the talus brakes. One at which no sand flows may be forgotten, and must not
    // remember.
    const Number before = flowed > none ? s.momentum * valuesFrom<Number>(s.slid + i) : none;
    const Number now = before + (steepness > rest || push < none ? push : none);
    const Number most = none + kMostOfBound, cut = now < most ? now : most;
    const Number sliding = cut > none ? cut : none, goesOn = flowed > none ? sliding : none;
    std::memcpy(s.sliding + i, &sliding, sizeof(Number));
    std::memcpy(s.goesOn + i, &goesOn, sizeof(Number));
    Mask bare;
    std::memcpy(&bare, s.bare + i, sizeof(Mask));
    return isAny(steepness > rest ? bare : Mask{});
}

/// Computes the facets from `begin` to before `end`. Returns the end of the list that begins at `found`.
template <bool kHeld, bool kBand>
std::int32_t* slideAll(const SweepFacets& sweep, std::size_t begin, std::size_t end, std::int32_t* found) {
    const SweepFacets s = sweep;  // a local copy stays in registers, because no other code can write to it
    std::size_t i = begin;
    for (; i + 4 <= end; i += 4) {
        if (slide<kHeld, kBand, Four, Bits>(s, i)) [[unlikely]] {
            for (std::size_t k = i; k < i + 4; ++k) {
                *found = static_cast<std::int32_t>(k);
                found += s.bare[k] != 0 && s.sliding[k] > 0 ? 1 : 0;
            }
        }
    }
    for (; i < end; ++i) {
        if (slide<kHeld, kBand, double, std::int64_t>(s, i)) {
            *found++ = static_cast<std::int32_t>(i);
        }
    }
    return found;
}

template <bool kHeld>
void flow(std::size_t count, const Level* __restrict levels, const double* __restrict undersides,
          const std::int32_t* __restrict from, const std::int32_t* __restrict to, const std::int32_t* __restrict left,
          const std::int32_t* __restrict right, const double* __restrict leftWeights,
          const double* __restrict rightWeights, const double* __restrict sliding, double* __restrict fluxes) {
    for (std::size_t i = 0; i < count; ++i) {
        const double ofLeft = leftWeights[i], ofRight = rightWeights[i];
        const double one = levels[from[i]].height, other = levels[to[i]].height;
        const double push = std::max(ofLeft * sliding[left[i]] + ofRight * sliding[right[i]], 0.0);
        double flux = std::trunc(push * (one - other));
        if constexpr (kHeld) {
            const double overOne = undersides[from[i]], overOther = undersides[to[i]];
            const double above = (one > other ? overOther : overOne) - (one > other ? other : one);
            const double bound = std::max(ofLeft, 0.0) + std::max(ofRight, 0.0);  // that the proofs allow, per height
            const double room = std::trunc(bound * std::max(above, 0.0));
            flux = std::max(std::min(flux, room), -room);
        }
        fluxes[i] = flux;
    }
}

template <bool kHeld>
void flowAll(const SweepEdges& s, std::size_t begin, std::size_t end) {
    flow<kHeld>(end - begin, s.levels, s.undersides, s.from + begin, s.to + begin, s.left + begin, s.right + begin,
                s.leftWeights + begin, s.rightWeights + begin, s.sliding, s.fluxes + begin);
}

/// Calls work(held, begin, end) for the groups below an obstacle and for the groups without one, in as few parts as
/// possible.
template <class Work>
void inParts(std::size_t count, const std::uint8_t* held, const Work& work) {
    for (std::size_t begin = 0; begin < count;) {
        const bool isHeld = held != nullptr && held[begin / kHeldTogether] != 0;
        std::size_t end = begin + kHeldTogether;
        while (end < count && isHeld == (held != nullptr && held[end / kHeldTogether] != 0)) {
            end += kHeldTogether;
        }
        end = std::min(end, count);
        work(isHeld, begin, end);
        begin = end;
    }
}

// Adds an edge's flux and its size with one instruction, so that finding where sand flows costs almost nothing.
void sumUp(std::size_t edges, const std::int32_t* from, const std::int32_t* to, const double* fluxes, double* sums) {
    auto* pairs = reinterpret_cast<Two*>(sums);
    const auto add = [&](std::size_t i) {
        const double flux = fluxes[i], size = std::abs(flux);
        pairs[from[i]] += Two{-flux, size};
        pairs[to[i]] += Two{flux, size};
    };
    // Successive edges share a vertex, and each addition to its sum must wait for the one before. Four edges far apart
    // do not wait. The order does not matter, because the sums are of whole numbers.
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

/// Lets all sand that would lie above height 0 on an open rim fall over it. Returns the volume that falls, counted in
/// 64 bits. The fluxes and the volume of a vertex are whole numbers whose sums are exact.
std::int64_t spill(std::size_t count, const std::int32_t* rim, const double* volumes, double* sums) {
    std::int64_t outflow = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double* const sum = sums + 2 * rim[i];
        const double over = std::max(volumes[rim[i]] + sum[0], 0.0);
        sum[0] -= over;
        sum[1] += over;
        outflow += static_cast<std::int64_t>(over);
    }
    return outflow;
}

/// Adds the sums to the volumes, and computes the heights. A height is a quotient that is rounded once.
SweepResult settleUp(std::size_t count, const double* __restrict sums, const double* __restrict stars,
                     const std::uint64_t* __restrict unwatched, double* __restrict volumes, Level* __restrict levels) {
    std::uint64_t moved = 0, met = 0;
    std::int64_t resting = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double inflow = sums[2 * i], flow = sums[2 * i + 1];
        // The library of emscripten has no std::bit_cast.
        moved |= __builtin_bit_cast(std::uint64_t, inflow + 0.0);  // minus zero counts as 0
        met |= __builtin_bit_cast(std::uint64_t, flow) & unwatched[i];
        resting += flow > 0 ? 0 : 1;
        volumes[i] += inflow;
        levels[i] = {volumes[i] / stars[i], flow};
    }
    return {moved != 0, met != 0, resting, 0};
}

}  // namespace

std::size_t slideFacets(const SweepFacets& s) {
    const bool band = s.start != nullptr;
    std::int32_t* found = s.slidBare;
    inParts(s.facets, s.held, [&](bool held, std::size_t begin, std::size_t end) {
        if (held) {
            found = band ? slideAll<true, true>(s, begin, end, found) : slideAll<true, false>(s, begin, end, found);
        } else {
            found = band ? slideAll<false, true>(s, begin, end, found) : slideAll<false, false>(s, begin, end, found);
        }
    });
    return static_cast<std::size_t>(found - s.slidBare);
}

void flowOverEdges(const SweepEdges& s) {
    inParts(s.edges, s.held, [&](bool held, std::size_t begin, std::size_t end) {
        held ? flowAll<true>(s, begin, end) : flowAll<false>(s, begin, end);
    });
}

SweepResult moveSand(const SweepSand& sand) {
    std::fill(sand.inflow, sand.inflow + 2 * sand.vertices, 0.0);
    sumUp(sand.edges, sand.from, sand.to, sand.fluxes, sand.inflow);
    const std::int64_t outflow = spill(sand.rimVertices, sand.rim, sand.volumes, sand.inflow);
    SweepResult result = settleUp(sand.vertices, sand.inflow, sand.stars, sand.unwatched, sand.volumes, sand.levels);
    result.outflow = outflow;
    return result;
}

}  // namespace sand::tin::SANDWALL_CODE_PATH
