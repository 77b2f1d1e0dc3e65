// SPDX-License-Identifier: Apache-2.0
// Private to the kernel of the sweeps, which is compiled once per code path: the sweep of a run of few blocks.
#pragma once

#include <algorithm>
#include <cstring>

#include "sand/grid/block_marks.hpp"
#include "sand/grid/erosion_loops.hpp"
#if defined(__wasm_simd128__)
#include "sand/grid/erosion_loops_wasm.hpp"
#endif

namespace sand::grid::SANDWALL_CODE_PATH {

inline constexpr int kShortBlock = 8;  // [cell], side of the blocks of a short run: a vector of AVX2
inline constexpr int kShortRun = 64;   // [cell], a longer run is faster row by row

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

/// One number of each column of a block. It is a vector of the compiler: in a loop over the columns, g++ would compute
/// the flux from the west once for two columns, and then keep the loop scalar.
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

    /// Computes the fluxes of rows [from, end) of the blocks.
    void computeFluxes(int from, int end) const {
        fluxesOfBlocks(eastLaw_, northLaw_, heights(from), sweep_.heightStride, sliding(from), buffers_.slidingStride,
                       end - from, width(), east(from), north(from), sweep_.fluxStride);
        const int stride = width() + 2;
        for (int y = from; run_.room != nullptr && y < end; ++y) {
            const std::int32_t* const room = run_.room + (y + 1) * stride + 1;
            limitToRoom(room, room + 1, width(), east(y));
            limitToRoom(room, room + stride, width(), north(y));
        }
    }

    const Sweep& sweep_;
    const RowBuffers& buffers_;
    const BlockRow& blocks_;
    const Run& run_;
    const Law &eastLaw_, &northLaw_;
};

}  // namespace sand::grid::SANDWALL_CODE_PATH
