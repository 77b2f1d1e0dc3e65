// SPDX-License-Identifier: Apache-2.0
// Private to the kernel of the sweeps: the loops of erosion_loops.hpp that compute fluxes, for WebAssembly. They take
// four faces at once, because clang 14 keeps them scalar. Each lane does the operations of the laws in
// erosion_laws.hpp, in the same order, so that all fluxes are the same.
#pragma once

#include <wasm_simd128.h>

#include "sand/grid/erosion_laws.hpp"
#include "sand/grid/erosion_loops.hpp"

namespace sand::grid::SANDWALL_CODE_PATH {
namespace lanes {

inline v128_t load(const std::int32_t* from) { return wasm_v128_load(from); }
inline v128_t real(v128_t number) { return wasm_f32x4_convert_i32x4(number); }
inline v128_t difference(const std::int32_t* a, const std::int32_t* b) { return wasm_i32x4_sub(load(a), load(b)); }
// These choose as std::max() and std::min() do. wasm_f32x4_max() would differ for -0.
inline v128_t larger(v128_t a, v128_t b) { return wasm_f32x4_pmax(a, b); }
inline v128_t smaller(v128_t a, v128_t b) { return wasm_f32x4_pmin(a, b); }

template <bool kBand>
v128_t banded(v128_t flux, v128_t sliding, v128_t slope, v128_t startThreshold) {
    return kBand ? wasm_v128_and(flux, wasm_v128_or(sliding, wasm_f32x4_gt(slope, startThreshold))) : flux;
}

/// A law for four faces. Its parameters are those of the law for one.
template <class Law>
class Lanes;

template <bool kBand>
class Lanes<Inertial<kBand>> {
public:
    explicit Lanes(const Inertial<kBand>& law)
        : threshold_(wasm_f32x4_splat(law.threshold)),
          startThreshold_(wasm_f32x4_splat(law.startThreshold)),
          limit_(wasm_f32x4_splat(law.limit)),
          push_(wasm_f32x4_splat(law.push)),
          along_(wasm_f32x4_splat(law.along)),
          momentum_(wasm_f32x4_splat(law.momentum)) {}

    v128_t operator()(v128_t difference, v128_t alongSum, v128_t last, v128_t sliding) const {
        const v128_t zero = wasm_f32x4_splat(0.0F), one = wasm_f32x4_splat(1.0F);
        const v128_t across = real(difference);
        const v128_t mean = wasm_f32x4_mul(along_, alongSum);
        const v128_t squares = wasm_f32x4_add(wasm_f32x4_mul(across, across), wasm_f32x4_mul(mean, mean));
        const v128_t slope = larger(squares, wasm_f32x4_splat(0.0625F));
        const v128_t driven = wasm_f32x4_mul(push_, wasm_f32x4_sub(one, wasm_f32x4_div(threshold_, slope)));
        const v128_t most = wasm_f32x4_mul(limit_, across);
        const v128_t forth = larger(most, zero), back = smaller(most, zero);
        const v128_t kept = smaller(larger(wasm_f32x4_mul(momentum_, real(last)), back), forth);
        const v128_t sum = wasm_f32x4_add(kept, wasm_f32x4_mul(driven, across));
        const v128_t flux = wasm_i32x4_trunc_sat_f32x4(smaller(larger(sum, back), forth));
        return banded<kBand>(flux, sliding, slope, startThreshold_);
    }

private:
    v128_t threshold_, startThreshold_, limit_, push_, along_, momentum_;
};

template <bool kBand>
class Lanes<Isotropic<kBand>> {
public:
    explicit Lanes(const Isotropic<kBand>& law)
        : threshold_(wasm_f32x4_splat(law.axis.threshold)),
          startThreshold_(wasm_f32x4_splat(law.axis.startThreshold)),
          limit_(wasm_f32x4_splat(law.axis.limit)),
          along_(wasm_f32x4_splat(law.axis.along)) {}

    v128_t operator()(v128_t difference, v128_t alongSum, v128_t /* last */, v128_t sliding) const {
        const v128_t across = real(difference);
        const v128_t mean = wasm_f32x4_mul(along_, alongSum);
        const v128_t slope =
            wasm_f32x4_sqrt(wasm_f32x4_add(wasm_f32x4_mul(across, across), wasm_f32x4_mul(mean, mean)));
        const v128_t excess = wasm_f32x4_sub(wasm_f32x4_splat(1.0F), wasm_f32x4_div(threshold_, slope));
        const v128_t share = wasm_v128_and(wasm_f32x4_gt(slope, threshold_), wasm_f32x4_mul(limit_, excess));
        const v128_t flux = wasm_i32x4_trunc_sat_f32x4(wasm_f32x4_mul(share, across));
        return banded<kBand>(flux, sliding, slope, startThreshold_);
    }

private:
    v128_t threshold_, startThreshold_, limit_, along_;
};

template <class Law>
v128_t eitherOf(const Sliding* behind, const Sliding* ahead) {
    if constexpr (Law::kBand) {
        return wasm_v128_or(load(behind), load(ahead));
    }
    return wasm_i32x4_splat(0);
}

}  // namespace lanes

inline constexpr int kLanes = 4;

template <class Law>
void fluxesBetween(const Law law, const std::int32_t* __restrict a, const std::int32_t* __restrict b,
                   const std::int32_t* __restrict alongA, const std::int32_t* __restrict alongB,
                   const SlidingPair& sliding, int count, std::int32_t* __restrict flux) {
    using namespace lanes;
    const Sliding* const behind = sliding.behind;
    const Sliding* const ahead = sliding.ahead;
    int i = 0;
    for (const Lanes<Law> four(law); i + kLanes <= count; i += kLanes) {
        const v128_t along = wasm_f32x4_add(real(load(alongA + i)), real(load(alongB + i)));
        wasm_v128_store(flux + i, four(difference(a + i, b + i), along, load(flux + i),
                                       lanes::eitherOf<Law>(behind + i, ahead + i)));
    }
    for (; i < count; ++i) {
        const float along = static_cast<float>(alongA[i]) + static_cast<float>(alongB[i]);
        flux[i] = law(a[i] - b[i], along, flux[i], eitherOf<Law>(behind, ahead, i));
    }
}

template <class Law>
void eastwards(const Law law, const std::int32_t* __restrict south, const std::int32_t* __restrict row,
               const std::int32_t* __restrict north, const SlidingPair& sliding, int count,
               std::int32_t* __restrict flux) {
    using namespace lanes;
    const Sliding* const behind = sliding.behind;
    const Sliding* const ahead = sliding.ahead;
    int i = 0;
    for (const Lanes<Law> four(law); i + kLanes <= count; i += kLanes) {
        const v128_t here = real(difference(north + i, south + i));
        const v128_t there = real(difference(north + i + 1, south + i + 1));
        wasm_v128_store(flux + i, four(difference(row + i, row + i + 1), wasm_f32x4_add(here, there), load(flux + i),
                                       lanes::eitherOf<Law>(behind + i, ahead + i)));
    }
    for (; i < count; ++i) {
        const auto here = static_cast<float>(north[i] - south[i]);
        const auto there = static_cast<float>(north[i + 1] - south[i + 1]);
        flux[i] = law(row[i] - row[i + 1], here + there, flux[i], eitherOf<Law>(behind, ahead, i));
    }
}

template <class Law>
void eastwardsAndNorthwards(const Law eastLaw, const Law northLaw, const std::int32_t* __restrict south,
                            const std::int32_t* __restrict row, const std::int32_t* __restrict north,
                            const SlidingPair& slides, int count, std::int32_t* __restrict east,
                            std::int32_t* __restrict northFlux, std::int32_t* __restrict copy) {
    using namespace lanes;
    int whole = 0;
    const Lanes<Law> northFour(northLaw);
    for (const Lanes<Law> eastFour(eastLaw); whole + kLanes <= count; whole += kLanes) {
        const int i = whole;
        const Sliding* const sliding = slides.behind + i;
        const v128_t here = real(difference(north + i, south + i));
        const v128_t there = real(difference(north + i + 1, south + i + 1));
        const v128_t riseEast = real(difference(row + i + 1, row + i - 1));
        const v128_t riseEastAhead = real(difference(north + i + 1, north + i - 1));
        const v128_t ahead = load(north + i);
        wasm_v128_store(east + i, eastFour(difference(row + i, row + i + 1), wasm_f32x4_add(here, there),
                                           load(east + i), lanes::eitherOf<Law>(sliding, sliding + 1)));
        wasm_v128_store(northFlux + i,
                        northFour(wasm_i32x4_sub(load(row + i), ahead), wasm_f32x4_add(riseEast, riseEastAhead),
                                  load(northFlux + i), lanes::eitherOf<Law>(sliding, slides.ahead + i)));
        wasm_v128_store(copy + i, ahead);
    }
    const Sliding* const sliding = slides.behind;
    for (int i = whole; i < count; ++i) {
        const auto riseNorth = static_cast<float>(north[i] - south[i]);
        const auto riseNorthEast = static_cast<float>(north[i + 1] - south[i + 1]);
        const auto riseEast = static_cast<float>(row[i + 1] - row[i - 1]);
        const auto riseEastAhead = static_cast<float>(north[i + 1] - north[i - 1]);
        east[i] =
            eastLaw(row[i] - row[i + 1], riseNorth + riseNorthEast, east[i], eitherOf<Law>(sliding, sliding + 1, i));
        northFlux[i] = northLaw(row[i] - north[i], riseEast + riseEastAhead, northFlux[i],
                                eitherOf<Law>(sliding, slides.ahead, i));
        copy[i] = north[i];
    }
}

/// The loop of erosion_short_run.hpp. `width` is a multiple of the lanes.
template <class Law>
void fluxesOfBlocks(const Law eastLaw, const Law northLaw, const std::int32_t* __restrict heights,
                    std::ptrdiff_t heightStride, const Sliding* __restrict sliding, std::ptrdiff_t slidingStride,
                    int rows, int width, std::int32_t* __restrict east, std::int32_t* __restrict north,
                    std::ptrdiff_t fluxStride) {
    using namespace lanes;
    const Lanes<Law> eastFour(eastLaw), northFour(northLaw);
    for (int x = 0; x < width; x += kLanes) {
        for (int y = 0; y < rows; ++y) {
            const std::int32_t* const row = heights + y * heightStride + x;
            const std::int32_t* const above = row + heightStride;
            const std::int32_t* const below = row - heightStride;
            const Sliding* const slides = sliding + y * slidingStride + x;
            std::int32_t* const toEast = east + y * fluxStride + x;
            std::int32_t* const toNorth = north + y * fluxStride + x;
            const v128_t riseNorth = real(difference(above, below));
            const v128_t riseNorthEast = real(difference(above + 1, below + 1));
            const v128_t riseEast = real(difference(row + 1, row - 1));
            const v128_t riseEastAhead = real(difference(above + 1, above - 1));
            wasm_v128_store(toEast, eastFour(difference(row, row + 1), wasm_f32x4_add(riseNorth, riseNorthEast),
                                             load(toEast), lanes::eitherOf<Law>(slides, slides + 1)));
            wasm_v128_store(toNorth, northFour(difference(row, above), wasm_f32x4_add(riseEast, riseEastAhead),
                                               load(toNorth), lanes::eitherOf<Law>(slides, slides + slidingStride)));
        }
    }
}

}  // namespace sand::grid::SANDWALL_CODE_PATH
