// SPDX-License-Identifier: Apache-2.0
// Private to the kernel of the sweeps, which is compiled once per code path: the fluxes of a piece of one cell row.
#pragma once

#include <array>

#include "sand/grid/erosion_loops.hpp"
#if defined(__wasm_simd128__)
#include "sand/grid/erosion_loops_wasm.hpp"
#endif

namespace sand::grid::SANDWALL_CODE_PATH {

/// [cell], longest piece of a row. The later loops over a piece find its numbers in the first-level cache.
inline constexpr int kPiece = 256;

/// One cell row of a run, with the rows beside it. All pointers are at column 0.
struct CellRow {
    int y;
    const std::int32_t *south, *here, *north;  // heights before the sweep [unit]
    const Sliding *sliding, *slidingAbove;     // of this row and of the next one; with a band
    const std::int32_t *room, *sand;           // limits of the run; null without limits
    std::ptrdiff_t limitStride;                // distance to the next row of `room` and `sand` [cell]
    std::int32_t *rise, *riseAbove;            // of this row and of the next one, see RowBuffers
    std::int32_t* oldAbove;                    // receives the heights of the next row, see RowBuffers
};

/// Fluxes of cells [from, end) of a row, through their eastern and northern faces and over the rim. With `kSandAlong`,
/// the slope along a face counts only the sand and not the ground below it.
template <class Law, bool kSandAlong>
class PieceFluxes {
public:
    PieceFluxes(const Sweep& sweep, const Law& eastLaw, const Law& northLaw, const CellRow& row, int from, int end)
        : sweep_(sweep), eastLaw_(eastLaw), northLaw_(northLaw), row_(row), from_(from), count_(end - from) {}

    /// Computes the fluxes. `isFirst` tells that the walk begins a run with this row. Returns the outflow over an open
    /// rim [unit · cell].
    std::int64_t compute(bool isFirst) {
        if constexpr (kSandAlong) {
            if (isFirst) {
                riseEast(row_.here, 0, row_.rise);
            }
        }
        if (row_.y == 0) {
            rimNorth(-1);
        }
        // The face at the eastern rim is computed like the others and corrected afterwards. A row whose number of faces
        // is a multiple of eight then has no remainder, which would take longer than all other faces.
        const std::int32_t lastInEast = east()[count_ - 1];
        if constexpr (kSandAlong) {
            row_.y == sweep_.rows - 1 ? rimNorth(row_.y) : northFluxesOfSand();
            eastFluxesOfSand();
        } else if (row_.y == sweep_.rows - 1) {
            rimNorth(row_.y);
            eastwards(eastLaw_, row_.south + from_, row_.here + from_, row_.north + from_, slidingInEast(), count_,
                      east());
        } else {
            eastwardsAndNorthwards(eastLaw_, northLaw_, row_.south + from_, row_.here + from_, row_.north + from_,
                                   slidingInNorth(), count_, east(), north(row_.y), row_.oldAbove + from_);
        }
        hold(1, east());
        if (row_.y < sweep_.rows - 1) {
            hold(row_.limitStride, north(row_.y));
        }
        rimEastAndWest(lastInEast);
        return outflow_;
    }

private:
    [[nodiscard]] std::int32_t* east() const { return sweep_.east + row_.y * sweep_.fluxStride + from_; }
    [[nodiscard]] std::int32_t* north(int y) const { return sweep_.north + y * sweep_.fluxStride + from_; }
    [[nodiscard]] SlidingPair slidingInEast() const { return {row_.sliding + from_, row_.sliding + from_ + 1}; }
    [[nodiscard]] SlidingPair slidingInNorth() const { return {row_.sliding + from_, row_.slidingAbove + from_}; }

    /// Computes for each cell of a row how much higher its eastern neighbour is than its western one, counting only
    /// sand.
    void riseEast(const std::int32_t* heights, std::ptrdiff_t above, std::int32_t* rise) {
        const std::int32_t* const cells = heights + from_;
        const std::int32_t* const sand = row_.sand + above + from_;
        sandDifferences(cells, cells - 1, sand, sand - 1, count_ + 1, steps_[0].data());
        sums(steps_[0].data(), steps_[0].data() + 1, count_, rise + from_);
    }
    /// Computes for each cell, and for one more, how much higher its northern neighbour is than its southern one,
    /// counting only sand.
    void riseNorth() {
        const std::int32_t* const sand = row_.sand + from_;
        const std::int32_t* const cells = row_.here + from_;
        sandDifferences(cells, row_.south + from_, sand, sand - row_.limitStride, count_ + 1, steps_[0].data());
        sandDifferences(row_.north + from_, cells, sand + row_.limitStride, sand, count_ + 1, steps_[1].data());
        sums(steps_[0].data(), steps_[1].data(), count_ + 1, riseNorth_.data());
    }

    /// Limits the fluxes to the cells that are `ahead` places further in `room` and `sand`.
    void hold(std::ptrdiff_t ahead, std::int32_t* flux) const {
        if (row_.room != nullptr) {
            limitToRoom(row_.room + from_, row_.room + from_ + ahead, count_, flux);
        }
        if (row_.sand != nullptr) {
            limitToSand(row_.sand + from_, row_.sand + from_ + ahead, count_, flux);
        }
    }

    void northFluxesOfSand() {
        riseEast(row_.north, row_.limitStride, row_.riseAbove);
        fluxesBetween(northLaw_, row_.here + from_, row_.north + from_, row_.rise + from_, row_.riseAbove + from_,
                      slidingInNorth(), count_, north(row_.y));
    }
    void eastFluxesOfSand() {
        riseNorth();
        fluxesBetween(eastLaw_, row_.here + from_, row_.here + from_ + 1, riseNorth_.data(), riseNorth_.data() + 1,
                      slidingInEast(), count_, east());
    }

    /// Computes the fluxes over the western and the eastern rim. `last` is the last sweep's flux through the face at
    /// the eastern end of the piece.
    void rimEastAndWest(std::int32_t last) {
        std::int32_t* const flux = east();
        if (sweep_.openRim && from_ == 0) {
            flux[-1] = -overRim(eastLaw_, 0, riseNorthOf(0), -flux[-1]);
        }
        if (from_ + count_ == sweep_.columns) {
            const int i = count_ - 1;
            flux[i] = sweep_.openRim ? overRim(eastLaw_, i, riseNorthOf(i), last) : 0;
        }
    }

    /// Computes the fluxes over the southern rim (y = -1) or the northern rim.
    void rimNorth(int y) {
        if (!sweep_.openRim) {
            return;
        }
        std::int32_t* const flux = north(y);
        for (int i = 0; i < count_; ++i) {
            const std::int32_t along = riseEastOf(i);
            flux[i] = y < 0 ? -overRim(northLaw_, i, along, -flux[i]) : overRim(northLaw_, i, along, flux[i]);
        }
    }

    /// Returns for one cell the number that riseEast() computes for all cells of a row.
    [[nodiscard]] std::int32_t riseEastOf(int i) const {
        if constexpr (kSandAlong) {
            return row_.rise[from_ + i];
        } else {
            return row_.here[from_ + i + 1] - row_.here[from_ + i - 1];
        }
    }
    /// Returns for one cell the number that riseNorth() computes for all cells of a row.
    [[nodiscard]] std::int32_t riseNorthOf(int i) const {
        if constexpr (kSandAlong) {
            return riseNorth_[static_cast<unsigned>(i)];
        } else {
            return row_.north[from_ + i] - row_.south[from_ + i];
        }
    }

    /// Returns the flux over an open rim, where sand falls to height 0 and never comes back. `rise` is the difference
    /// along the rim beside the cell.
    std::int32_t overRim(const Law& law, int i, std::int32_t rise, std::int32_t last) {
        const std::int32_t slides = Law::kBand ? row_.sliding[from_ + i] : 0;
        const float along = 2 * static_cast<float>(rise);
        std::int32_t flux = std::max(law(row_.here[from_ + i], along, last, slides), 0);
        if (row_.sand != nullptr) {
            flux = std::min(flux, row_.sand[from_ + i] / 4);
        }
        outflow_ += flux;
        return flux;
    }

    const Sweep& sweep_;
    const Law eastLaw_, northLaw_;
    const CellRow& row_;
    const int from_, count_;
    std::int64_t outflow_ = 0;
    // Uninitialised, because a piece may be short. Empty if slopes are taken from the heights themselves.
    static constexpr std::size_t kRow = kSandAlong ? kPiece + 1 : 0;
    std::array<std::array<std::int32_t, kRow>, 2> steps_;
    std::array<std::int32_t, kRow> riseNorth_;
};

}  // namespace sand::grid::SANDWALL_CODE_PATH
