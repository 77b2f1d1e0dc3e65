// SPDX-License-Identifier: Apache-2.0
// Private to the kernel of the sweeps, which is compiled once per code path: the loops over the cells of a row. Each
// handles a vector of cells at a time. The functions are free, take restricted pointers, and get laws as copies. With
// members in reach, g++ keeps the loops scalar.
#pragma once

#include "sand/grid/erosion_laws.hpp"

namespace sand::grid::SANDWALL_CODE_PATH {

/// Masks of sliding cells in two parallel runs of cells. They have no meaning without a band.
struct SlidingPair {
    const Sliding* behind;
    const Sliding* ahead;
};

template <class Law>
std::int32_t eitherOf(const Sliding* behind, const Sliding* ahead, int i) {
    if constexpr (Law::kBand) {
        return behind[i] | ahead[i];
    }
    return 0;
}

#if !defined(__wasm_simd128__)  // erosion_loops_wasm.hpp has these three loops for WebAssembly
/// Computes the fluxes between two parallel runs of cells. `alongA` and `alongB` hold each cell's sum of two
/// differences along the faces.
template <class Law>
void fluxesBetween(const Law law, const std::int32_t* __restrict a, const std::int32_t* __restrict b,
                   const std::int32_t* __restrict alongA, const std::int32_t* __restrict alongB,
                   const SlidingPair& sliding, int count, std::int32_t* __restrict flux) {
    const Sliding* __restrict behind = sliding.behind;
    const Sliding* __restrict ahead = sliding.ahead;
    for (int i = 0; i < count; ++i) {
        const float along = static_cast<float>(alongA[i]) + static_cast<float>(alongB[i]);
        flux[i] = law(a[i] - b[i], along, flux[i], eitherOf<Law>(behind, ahead, i));
    }
}

/// Computes the fluxes from a row of cells to their eastern neighbours. `south` and `north` are the rows beside it.
template <class Law>
void eastwards(const Law law, const std::int32_t* __restrict south, const std::int32_t* __restrict row,
               const std::int32_t* __restrict north, const SlidingPair& sliding, int count,
               std::int32_t* __restrict flux) {
    const Sliding* __restrict behind = sliding.behind;
    const Sliding* __restrict ahead = sliding.ahead;
    for (int i = 0; i < count; ++i) {
        const auto here = static_cast<float>(north[i] - south[i]);
        const auto there = static_cast<float>(north[i + 1] - south[i + 1]);
        flux[i] = law(row[i] - row[i + 1], here + there, flux[i], eitherOf<Law>(behind, ahead, i));
    }
}

/// Computes the fluxes from a row of cells to their eastern and to their northern neighbours. `copy` receives the row
/// in the north.
template <class Law>
void eastwardsAndNorthwards(const Law eastLaw, const Law northLaw, const std::int32_t* __restrict south,
                            const std::int32_t* __restrict row, const std::int32_t* __restrict north,
                            const SlidingPair& slides, int count, std::int32_t* __restrict east,
                            std::int32_t* __restrict northFlux, std::int32_t* __restrict copy) {
    const Sliding* __restrict sliding = slides.behind;
    const Sliding* __restrict slidingAbove = slides.ahead;
    for (int i = 0; i < count; ++i) {
        const std::int32_t ahead = north[i];
        const auto riseNorth = static_cast<float>(ahead - south[i]);
        const auto riseNorthEast = static_cast<float>(north[i + 1] - south[i + 1]);
        const auto riseEast = static_cast<float>(row[i + 1] - row[i - 1]);
        const auto riseEastAhead = static_cast<float>(north[i + 1] - north[i - 1]);
        east[i] =
            eastLaw(row[i] - row[i + 1], riseNorth + riseNorthEast, east[i], eitherOf<Law>(sliding, sliding + 1, i));
        northFlux[i] =
            northLaw(row[i] - ahead, riseEast + riseEastAhead, northFlux[i], eitherOf<Law>(sliding, slidingAbove, i));
        copy[i] = ahead;
    }
}
#endif

/// Limits a flux to a quarter of `forth`, or of `back` in the other direction: the room of the cell that receives it,
/// or the sand of the cell that gives it. The four faces of a cell then never bring more than fits, or take more than
/// it has. `forth` and `back` are at least 0.
inline std::int32_t limitedToQuarter(std::int32_t flux, std::int32_t forth, std::int32_t back) {
    return std::max(std::min(flux, forth >> 2), -(back >> 2));
}
inline void limitToQuarter(const std::int32_t* __restrict forth, const std::int32_t* __restrict back, int count,
                           std::int32_t* __restrict flux) {
    for (int i = 0; i < count; ++i) {
        flux[i] = limitedToQuarter(flux[i], forth[i], back[i]);
    }
}

/// Adds the fluxes to the heights of a row.
inline void addUp(const std::int32_t* __restrict east, const std::int32_t* __restrict south,
                  const std::int32_t* __restrict north, int count, std::int32_t* __restrict heights) {
    for (int i = 0; i < count; ++i) {
        heights[i] += east[i - 1] - east[i] + south[i] - north[i];
    }
}

/// Does the same as addUp(), and makes `flowed` other than 0 in each column in which sand flows.
inline void addUpAndRecord(const std::int32_t* __restrict east, const std::int32_t* __restrict south,
                           const std::int32_t* __restrict north, int count, std::int32_t* __restrict heights,
                           std::int32_t* __restrict flowed) {
    for (int i = 0; i < count; ++i) {
        heights[i] += east[i - 1] - east[i] + south[i] - north[i];
        flowed[i] |= east[i] | north[i];
    }
}

inline void record(const std::int32_t* __restrict east, const std::int32_t* __restrict north, int count,
                   std::int32_t* __restrict flowed) {
    for (int i = 0; i < count; ++i) {
        flowed[i] |= east[i] | north[i];
    }
}

/// Writes in which cells of a row sand slid in the last sweep, from the fluxes of that sweep. `south` holds those from
/// the row below.
inline void markRow(const std::int32_t* __restrict east, const std::int32_t* __restrict south,
                    const std::int32_t* __restrict north, int count, Sliding* __restrict sliding) {
    for (int i = 0; i < count; ++i) {
        sliding[i] = (east[i - 1] | east[i] | south[i] | north[i]) != 0 ? -1 : 0;
    }
}

}  // namespace sand::grid::SANDWALL_CODE_PATH
