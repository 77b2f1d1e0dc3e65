// SPDX-License-Identifier: Apache-2.0
// Private to the kernel of the sweeps, which is compiled once per code path: the sweep of a run of few blocks.
#pragma once

#include <algorithm>
#include <cstring>

#include "sand/grid/block_marks.hpp"
#include "sand/grid/erosion_fluxes.hpp"

namespace sand::grid::SANDWALL_CODE_PATH {

inline constexpr int kShortBlock = kVector;  // [cell], side of the blocks of a short run
inline constexpr int kShortRun = 64;         // [cell], a longer run is faster row by row

// The loops over a run go block by block. The loop over the eight columns of a block then becomes one or two vectors,
// without a remainder and without a test of its length. All pointers are at the first cell of the first row.

#if !defined(__wasm_simd128__)  // erosion_loops_wasm.hpp has this loop for WebAssembly
/// Computes the fluxes of `rows` rows of cells to their eastern and northern neighbours.
template <class Law>
void fluxesOfBlocks(const Law eastLaw, const Law northLaw, const std::int32_t* __restrict heights,
                    std::ptrdiff_t heightStride, const Sliding* __restrict sliding, std::ptrdiff_t slidingStride,
                    int rows, int width, std::int32_t* __restrict east, std::int32_t* __restrict north,
                    std::ptrdiff_t fluxStride) {
    for (int x = 0; x < width; x += kShortBlock) {
        for (int y = 0; y < rows; ++y) {
            const std::int32_t* const row = heights + y * heightStride + x;
            const std::int32_t* const above = row + heightStride;
            const std::int32_t* const below = row - heightStride;
            const Sliding* const slides = sliding + y * slidingStride + x;
            std::int32_t* const toEast = east + y * fluxStride + x;
            std::int32_t* const toNorth = north + y * fluxStride + x;
            for (int i = 0; i < kShortBlock; ++i) {
                const auto riseNorth = static_cast<float>(above[i] - below[i]);
                const auto riseNorthEast = static_cast<float>(above[i + 1] - below[i + 1]);
                const auto riseEast = static_cast<float>(row[i + 1] - row[i - 1]);
                const auto riseEastAhead = static_cast<float>(above[i + 1] - above[i - 1]);
                toEast[i] = eastLaw(row[i] - row[i + 1], riseNorth + riseNorthEast, toEast[i],
                                    eitherOf<Law>(slides, slides + 1, i));
                toNorth[i] = northLaw(row[i] - above[i], riseEast + riseEastAhead, toNorth[i],
                                      eitherOf<Law>(slides, slides + slidingStride, i));
            }
        }
    }
}
#endif

/// Does the same where a tool limits slopes and fluxes. `room` is what fits below the tool.
template <class Law>
void heldFluxesOfBlocks(const Law eastLaw, const Law northLaw, const std::int32_t* __restrict heights,
                        std::ptrdiff_t heightStride, const std::int32_t* __restrict room, std::ptrdiff_t roomStride,
                        const Sliding* __restrict sliding, std::ptrdiff_t slidingStride, int rows, int width,
                        std::int32_t* __restrict east, std::int32_t* __restrict north, std::ptrdiff_t fluxStride) {
    for (int x = 0; x < width; x += kShortBlock) {
        for (int y = 0; y < rows; ++y) {
            const LimitedRow row{heights + y * heightStride + x, nullptr, room + y * roomStride + x};
            const LimitedRow above{row.heights + heightStride, nullptr, row.room + roomStride};
            const LimitedRow below{row.heights - heightStride, nullptr, row.room - roomStride};
            const Sliding* const slides = sliding + y * slidingStride + x;
            std::int32_t* const toEast = east + y * fluxStride + x;
            std::int32_t* const toNorth = north + y * fluxStride + x;
            const auto riseNorth = [&](int i) {
                return static_cast<float>(countedStep<false>(above, i, row, i) + countedStep<false>(row, i, below, i));
            };
            const auto riseEast = [](const LimitedRow& of, int i) {
                return static_cast<float>(countedStep<false>(of, i, of, i - 1) + countedStep<false>(of, i + 1, of, i));
            };
            for (int i = 0; i < kShortBlock; ++i) {
                const std::int32_t forthEast =
                    eastLaw(row.heights[i] - row.heights[i + 1], riseNorth(i) + riseNorth(i + 1), toEast[i],
                            eitherOf<Law>(slides, slides + 1, i));
                const std::int32_t forthNorth =
                    northLaw(row.heights[i] - above.heights[i], riseEast(row, i) + riseEast(above, i), toNorth[i],
                             eitherOf<Law>(slides, slides + slidingStride, i));
                toEast[i] = limitedToQuarter(forthEast, row.room[i + 1], row.room[i]);
                toNorth[i] = limitedToQuarter(forthNorth, above.room[i], row.room[i]);
            }
        }
    }
}

/// Does the same as markRow() for `rows` rows of cells.
inline void markBlocks(const std::int32_t* __restrict east, const std::int32_t* __restrict north,
                       std::ptrdiff_t fluxStride, int rows, int width, Sliding* __restrict sliding,
                       std::ptrdiff_t slidingStride) {
    for (int x = 0; x < width; x += kShortBlock) {
        for (int y = 0; y < rows; ++y) {
            const std::ptrdiff_t flux = y * fluxStride + x;
            for (int i = 0; i < kShortBlock; ++i) {
                const std::int32_t own = east[flux + i] | north[flux + i];
                const std::int32_t others = east[flux + i - 1] | north[flux - fluxStride + i];
                sliding[y * slidingStride + x + i] = (own | others) != 0 ? -1 : 0;
            }
        }
    }
}

/// One number of each column of a block. It is a vector of the compiler. In a loop over the columns, g++ would share
/// the flux from the west between two columns, and keep the loop scalar.
using Columns [[gnu::vector_size(4 * kShortBlock)]] = std::int32_t;

inline Columns columnsAt(const std::int32_t* first) {
    Columns columns;
    std::memcpy(&columns, first, sizeof columns);
    return columns;
}

/// Adds the fluxes to the heights of a block, except those of its first and last cell row. Returns the bits of `flow`
/// of the whole block.
inline std::uint8_t addUpBlock(const std::int32_t* __restrict east, const std::int32_t* __restrict north,
                               std::ptrdiff_t fluxStride, std::int32_t* __restrict heights,
                               std::ptrdiff_t heightStride) {
    Columns south = columnsAt(north);  // fluxes to the row that the loop has reached
    const Columns first = columnsAt(east) | south;
    Columns between{}, last{};
    for (int y = 1; y < kShortBlock; ++y) {
        const std::int32_t* const row = east + y * fluxStride;
        const Columns toEast = columnsAt(row), toNorth = columnsAt(north + y * fluxStride);
        (y < kShortBlock - 2 ? between : last) |= toEast | toNorth;
        if (y < kShortBlock - 1) {
            std::int32_t* const cells = heights + y * heightStride;
            const Columns sum = columnsAt(cells) + columnsAt(row - 1) - toEast + south - toNorth;
            std::memcpy(cells, &sum, sizeof sum);
        }
        south = toNorth;
    }
    const Columns flowing = ((first != 0) & (flow::kSomewhere | flow::kSouth)) |
                            ((last != 0) & (flow::kSomewhere | flow::kNorth)) | ((between != 0) & flow::kSomewhere);
    std::int32_t bits = flowing[0] != 0 ? flow::kWest : 0;
    bits |= (flowing[kShortBlock - 2] | flowing[kShortBlock - 1]) != 0 ? flow::kEast : 0;
    for (int i = 0; i < kShortBlock; ++i) {
        bits |= flowing[i];
    }
    return static_cast<std::uint8_t>(bits);
}

/// The sweep of a short run that touches no rim of the field. All fluxes are computed before a height changes, because
/// the numbers of so few blocks stay in the first-level cache.
template <class Law>
class ShortRunSweep {
public:
    /// Returns whether a run can be swept in this way: its blocks are whole, and slopes come from the heights alone.
    static bool fits(const Sweep& sweep, const BlockRow& blocks, const Run& run) {
        return sweep.blockSize == kShortBlock && run.x1 - run.x0 <= kShortRun && run.sand == nullptr && run.x0 > 0 &&
               blocks.y0 > 0 && run.x1 < sweep.columns && blocks.y1 < sweep.rows;
    }

    ShortRunSweep(const Sweep& sweep, const RowBuffers& buffers, const BlockRow& blocks, const Run& run,
                  const Law& east, const Law& north)
        : sweep_(sweep), buffers_(buffers), blocks_(blocks), run_(run), eastLaw_(east), northLaw_(north) {}

    /// Computes the fluxes of the first cell row. The other rows wait for the fluxes that are kept for the band.
    std::int64_t first() const {
        if constexpr (Law::kBand) {
            mark();
        }
        computeFluxes(0, 1);
        return 0;
    }

    /// Computes the other fluxes, and balances all cell rows except the last one.
    std::int64_t rest() const {
        if constexpr (Law::kBand) {
            const std::int32_t* const last = north(kShortBlock - 1);
            std::copy(last, last + width(), buffers_.before + run_.x0);
        }
        computeFluxes(1, kShortBlock);
        if (!blocks_.keepsFirst) {
            addUp(east(0), north(-1), north(0), width(), heights(0));
        }
        std::uint8_t* flowed = sweep_.flowed + blocks_.y0 / kShortBlock * sweep_.flowedStride + run_.x0 / kShortBlock;
        for (int x = 0; x < width(); x += kShortBlock) {
            *flowed++ = addUpBlock(east(0) + x, north(0) + x, sweep_.fluxStride, heights(0) + x, sweep_.heightStride);
        }
        return 0;
    }

private:
    [[nodiscard]] int width() const { return run_.x1 - run_.x0; }
    /// Returns a pointer to the run's first cell in row y of the blocks.
    [[nodiscard]] std::int32_t* heights(int y) const {
        return sweep_.heights + (blocks_.y0 + y) * sweep_.heightStride + run_.x0;
    }
    [[nodiscard]] std::int32_t* east(int y) const {
        return sweep_.east + (blocks_.y0 + y) * sweep_.fluxStride + run_.x0;
    }
    [[nodiscard]] std::int32_t* north(int y) const {
        return sweep_.north + (blocks_.y0 + y) * sweep_.fluxStride + run_.x0;
    }
    [[nodiscard]] Sliding* sliding(int y) const { return buffers_.sliding[0] + y * buffers_.slidingStride + run_.x0; }

    /// Marks the sliding cells of all cell rows, and of the row above them.
    void mark() const {
        const auto copyTo = [this](int y, const Sliding* row) { std::copy(row + run_.x0, row + run_.x1, sliding(y)); };
        if (blocks_.slidingFirst != nullptr) {
            copyTo(0, blocks_.slidingFirst);
        } else {
            markRow(east(0), buffers_.before + run_.x0, north(0), width(), sliding(0));
        }
        int rows = kShortBlock;
        if (blocks_.slidingAbove != nullptr) {  // another thread may be writing the fluxes of the row above
            copyTo(kShortBlock, blocks_.slidingAbove);
            --rows;
        }
        markBlocks(east(1), north(1), sweep_.fluxStride, rows, width(), sliding(1), buffers_.slidingStride);
        for (int y = 0; y < kShortBlock; ++y) {
            sliding(y)[width()] = 0;  // this cell rests
        }
    }

    /// Computes the fluxes of rows [from, end) of the blocks. Rows in which the tool limits the same columns go
    /// together.
    void computeFluxes(int from, int end) const {
        while (from < end) {
            const Obstacle::Columns held = heldColumns(from);
            int to = from + 1;
            while (to < end && heldColumns(to) == held) {
                ++to;
            }
            computeFree({run_.x0, from, held.x0, to});
            computeHeld({held.x0, from, held.x1, to});
            computeFree({held.x1, from, run_.x1, to});
            from = to;
        }
    }
    /// Returns the columns of the run whose fluxes the tool limits in row y of the blocks.
    [[nodiscard]] Obstacle::Columns heldColumns(int y) const {
        const Obstacle::Columns held =
            sweep_.held == nullptr ? Obstacle::Columns{0, 0} : sweep_.held->columns(blocks_.y0 + y);
        const Obstacle::Columns here{std::max(held.x0, run_.x0), std::min(held.x1, run_.x1)};
        return here.x0 < here.x1 ? here : Obstacle::Columns{run_.x1, run_.x1};
    }
    void computeFree(const CellRect& cells) const {
        const int x = cells.x0 - run_.x0, y = cells.y0;
        fluxesOfBlocks(eastLaw_, northLaw_, heights(y) + x, sweep_.heightStride, sliding(y) + x, buffers_.slidingStride,
                       cells.y1 - y, cells.x1 - cells.x0, east(y) + x, north(y) + x, sweep_.fluxStride);
    }
    void computeHeld(const CellRect& cells) const {
        if (cells.empty()) {
            return;
        }
        constexpr std::ptrdiff_t kStride = kShortRun + 2 * kVector;
        std::array<std::int32_t, (kShortBlock + 2) * kStride>
            room;  // uninitialised: of the cells and one more on each side
        std::int32_t* row = room.data();
        for (int y = cells.y0 - 1; y <= cells.y1; ++y, row += kStride) {
            const int x = cells.x0 - 1;
            roomBelow(sweep_.held->undersides(blocks_.y0 + y) + x, heights(y) + (x - run_.x0), cells.x1 - x + 1, row);
        }
        const int x = cells.x0 - run_.x0, y = cells.y0;
        heldFluxesOfBlocks(eastLaw_, northLaw_, heights(y) + x, sweep_.heightStride, room.data() + kStride + 1, kStride,
                           sliding(y) + x, buffers_.slidingStride, cells.y1 - y, cells.x1 - cells.x0, east(y) + x,
                           north(y) + x, sweep_.fluxStride);
    }

    const Sweep& sweep_;
    const RowBuffers& buffers_;
    const BlockRow& blocks_;
    const Run& run_;
    const Law &eastLaw_, &northLaw_;
};

}  // namespace sand::grid::SANDWALL_CODE_PATH
