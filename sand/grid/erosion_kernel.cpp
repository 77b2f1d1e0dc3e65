// SPDX-License-Identifier: Apache-2.0
// Compiled once per code path, with -O3, because g++ 12 does not vectorise these loops at -O2.
#include "sand/grid/erosion_kernel.hpp"

#include <algorithm>

#include "sand/grid/erosion_fluxes.hpp"
#include "sand/grid/erosion_report.hpp"
#include "sand/grid/erosion_short_run.hpp"
#include "sand/grid/erosion_thin.hpp"

namespace sand::grid::SANDWALL_CODE_PATH {
namespace {

bool isOdd(int y) { return (y & 1) != 0; }

/// The sweep of one run of blocks.
template <class Law, bool kOnGround>
class RunSweep {
public:
    RunSweep(const Sweep& sweep, const RowBuffers& buffers, const BlockRow& blocks, const Run& run, const Law& east,
             const Law& north)
        : sweep_(sweep), buffers_(buffers), blocks_(blocks), run_(run), eastLaw_(east), northLaw_(north) {}

    /// Sweeps the first cell row. Returns its outflow [unit · cell].
    std::int64_t first() const {
        const int y = blocks_.y0;
        for (std::int32_t* const flowed : buffers_.flowed) {
            std::fill(flowed + run_.x0, flowed + run_.x1, 0);
        }
        if (Law::kBand && blocks_.slidingFirst == nullptr) {
            // The walk has already swept the row below.
            const std::int32_t* const south = y == 0 ? north(-1) : buffers_.before;
            Sliding* const sliding = buffers_.sliding[isOdd(y)];
            markRow(east(y) + run_.x0, south + run_.x0, north(y) + run_.x0, run_.x1 - run_.x0, sliding + run_.x0);
            sliding[run_.x1] = 0;  // this cell rests
        }
        return sweepRow(y);
    }

    /// Sweeps all other cell rows, and writes where sand flows. Returns their outflow [unit · cell].
    std::int64_t rest() const {
        std::int64_t outflow = 0;
        for (int y = blocks_.y0 + 1; y < blocks_.y1; ++y) {
            outflow += sweepRow(y);
        }
        reportFlow(sweep_, buffers_, blocks_, run_);
        return outflow;
    }

private:
    [[nodiscard]] std::int32_t* field(int y) const { return sweep_.heights + y * sweep_.heightStride; }
    [[nodiscard]] std::int32_t* east(int y) const { return sweep_.east + y * sweep_.fluxStride; }
    [[nodiscard]] std::int32_t* north(int y) const { return sweep_.north + y * sweep_.fluxStride; }
    /// Returns whether row y is balanced as soon as its fluxes are known.
    [[nodiscard]] bool balances(int y) const { return y + 1 < blocks_.y1 && !(blocks_.keepsFirst && y == blocks_.y0); }
    /// Returns the heights of row y from before the sweep, which has perhaps balanced this row.
    [[nodiscard]] const std::int32_t* oldHeights(int y) const {
        return y >= blocks_.y0 && balances(y) ? buffers_.old[y % 3] : field(y);
    }

    [[nodiscard]] CellRow rowAt(int y) const {
        CellRow row{.y = y,
                    .south = {oldHeights(y - 1), nullptr, nullptr},
                    .here = {oldHeights(y), nullptr, nullptr},
                    .north = {field(y + 1), nullptr, nullptr},
                    .sliding = buffers_.sliding[isOdd(y)],
                    .slidingAbove = buffers_.sliding[isOdd(y + 1)],
                    .oldAbove = buffers_.old[(y + 1) % 3]};
        if (y == blocks_.y0 && blocks_.slidingFirst != nullptr) {
            row.sliding = blocks_.slidingFirst;
        }
        if (y + 1 == blocks_.y1 && blocks_.slidingAbove != nullptr) {
            row.slidingAbove = blocks_.slidingAbove;
        }
        if constexpr (kOnGround) {
            row.south = limitedRow(y - 1);
            row.here = limitedRow(y);
            row.north = limitedRow(y + 1);
        }
        return row;
    }
    /// Returns the row of the run's limits.
    [[nodiscard]] LimitedRow limitedRow(int y) const {
        const std::ptrdiff_t first = (y - blocks_.y0 + 1) * std::ptrdiff_t{run_.x1 - run_.x0 + 2} + 1 - run_.x0;
        return {run_.heights + first, run_.sand + first, run_.room + first};
    }

    std::int64_t sweepRow(int y) const {
        const CellRow row = rowAt(y);
        if (!kOnGround && balances(y)) {
            keepOldHeights(y);
        }
        std::int64_t outflow = 0;
        for (int from = run_.x0, end = from; from < run_.x1; from = end) {
            end = std::min(from + kPiece, run_.x1);
            const bool held = !kOnGround && cutToHeld(sweep_.held, y, from, end);
            if constexpr (Law::kBand) {
                markAbove(y, from, end);
            }
            outflow += fluxesOf({sweep_, eastLaw_, northLaw_, row, from, end}, held);
            useFluxes(y, from, end);
        }
        return outflow;
    }

    static std::int64_t fluxesOf(const Piece<Law>& piece, bool held) {
        if constexpr (kOnGround) {
            return hasThinSand(piece) ? ThinFluxes<Law>(piece).compute() : limitedFluxes(piece);
        }
        if (!held) {
            return freeFluxes(piece);
        }
        if (!piece.isLastRow()) {
            const std::int32_t* const north = piece.row.north.heights;
            std::copy(north + piece.from, north + piece.end, piece.row.oldAbove + piece.from);
        }
        CellRow row = piece.row;
        addUndersides(*piece.sweep.held, row);
        return limitedFluxes({piece.sweep, piece.eastLaw, piece.northLaw, row, piece.from, piece.end});
    }
    static std::int64_t limitedFluxes(const Piece<Law>& piece) {
        LimitedFluxes<Law, kOnGround> fluxes(piece.count());
        fluxes.begin(piece);
        return fluxes.compute(piece);
    }

    /// Keeps the heights of row y in a buffer. Those of the run's cells are there already, except in the first row.
    void keepOldHeights(int y) const {
        std::int32_t* const old = buffers_.old[y % 3];
        if (y == blocks_.y0) {
            std::copy(field(y) + run_.x0, field(y) + run_.x1, old + run_.x0);
        }
        old[run_.x0 - 1] = field(y)[run_.x0 - 1];
        old[run_.x1] = field(y)[run_.x1];
    }

    /// Marks the sliding cells of row y + 1. The fluxes of row y must still be those of the last sweep.
    void markAbove(int y, int from, int end) const {
        if (y + 1 == sweep_.rows) {
            return;
        }
        if (y + 1 == blocks_.y1) {
            std::copy(north(y) + from, north(y) + end, buffers_.before + from);
            if (blocks_.slidingAbove != nullptr) {
                return;
            }
        }
        Sliding* const sliding = buffers_.sliding[isOdd(y + 1)];
        markRow(east(y + 1) + from, north(y) + from, north(y + 1) + from, end - from, sliding + from);
        sliding[run_.x1] = 0;
    }

    /// Records where sand flows, and balances the row if nothing else needs its old heights.
    void useFluxes(int y, int from, int end) const {
        std::int32_t* const flowed = buffers_.flowed[y == blocks_.y0 ? 0 : y >= blocks_.y1 - 2 ? 2 : 1];
        if (balances(y)) {
            addUpAndRecord(east(y) + from, north(y - 1) + from, north(y) + from, end - from, field(y) + from,
                           flowed + from);
        } else {
            record(east(y) + from, north(y) + from, end - from, flowed + from);
        }
        if (from == 0) {
            flowed[0] |= east(y)[-1];
        }
        if (y == 0) {  // the faces at the southern rim are not northern faces of any cell
            for (int x = from; x < end; ++x) {
                buffers_.flowed[1][x] |= north(-1)[x];
            }
        }
    }

    const Sweep& sweep_;
    const RowBuffers& buffers_;
    const BlockRow& blocks_;
    const Run& run_;
    const Law eastLaw_, northLaw_;
};

/// Calls task(run sweep) for each run, with the fastest sweep that the run allows.
template <class Law, class Task>
void forEachRun(const Sweep& sweep, const RowBuffers& buffers, const BlockRow& row, const Law& east, const Law& north,
                const Task& task) {
    for (const Run& run : row.runs) {
        if (ShortRunSweep<Law>::fits(sweep, row, run)) {
            task(ShortRunSweep<Law>(sweep, buffers, row, run, east, north));
        } else if (run.sand != nullptr) {
            task(RunSweep<Law, true>(sweep, buffers, row, run, east, north));
        } else {
            task(RunSweep<Law, false>(sweep, buffers, row, run, east, north));
        }
    }
}

template <class Law>
std::int64_t walkWith(const Sweep& sweep, const RowBuffers& buffers, const BlockRow& row, const Law& east,
                      const Law& north) {
    std::int64_t outflow = 0;
    forEachRun(sweep, buffers, row, east, north, [&](const auto& run) { outflow += run.first(); });
    balance(sweep, &buffers, row.below, row.y0 - 1);
    forEachRun(sweep, buffers, row, east, north, [&](const auto& run) { outflow += run.rest(); });
    return outflow;
}

template <bool kBand>
std::int64_t walkWithBand(const Sweep& sweep, const RowBuffers& buffers, const BlockRow& row) {
    if (!sweep.inertial) {
        using Law = Isotropic<kBand>;
        return walkWith(sweep, buffers, row, Law{sweep.eastLaw}, Law{sweep.northLaw});
    }
    using Law = Inertial<kBand>;
    return walkWith(sweep, buffers, row, Law(sweep.eastLaw, sweep.momentum), Law(sweep.northLaw, sweep.momentum));
}

}  // namespace

std::int64_t walk(const Sweep& sweep, const RowBuffers& buffers, const BlockRow& row) {
    return sweep.band ? walkWithBand<true>(sweep, buffers, row) : walkWithBand<false>(sweep, buffers, row);
}

void balance(const Sweep& sweep, const RowBuffers* buffers, std::span<const Run> runs, int y) {
    for (const Run& run : runs) {
        const std::ptrdiff_t flux = y * sweep.fluxStride + run.x0;
        addUp(sweep.east + flux, sweep.north + flux - sweep.fluxStride, sweep.north + flux, run.x1 - run.x0,
              sweep.heights + y * sweep.heightStride + run.x0);
        if (buffers != nullptr && sweep.band) {
            std::fill(buffers->before + run.x0, buffers->before + run.x1, 0);
        }
    }
}

void markSliding(const Sweep& sweep, std::span<const Run> runs, int y, Sliding* sliding) {
    for (const Run& run : runs) {
        const std::ptrdiff_t flux = y * sweep.fluxStride + run.x0;
        markRow(sweep.east + flux, sweep.north + flux - sweep.fluxStride, sweep.north + flux, run.x1 - run.x0,
                sliding + run.x0);
    }
}

}  // namespace sand::grid::SANDWALL_CODE_PATH
