// SPDX-License-Identifier: Apache-2.0
// Private to the kernel of the sweeps, which is compiled once per code path: where sand flows in the blocks of a run.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "sand/grid/block_marks.hpp"
#include "sand/grid/erosion_fluxes.hpp"

namespace sand::grid::SANDWALL_CODE_PATH {

/// Joins the bits of three rows of RowBuffers::flowed in each column: where sand flows in this column of a block.
inline void joinRows(const std::int32_t* __restrict first, const std::int32_t* __restrict between,
                     const std::int32_t* __restrict last, int northOfFirst, int count, std::uint8_t* __restrict bits) {
    for (int i = 0; i < count; ++i) {
        const int south = first[i] != 0 ? flow::kSomewhere | flow::kSouth | northOfFirst : 0;
        const int north = last[i] != 0 ? flow::kSomewhere | flow::kNorth : 0;
        bits[i] = static_cast<std::uint8_t>(south | north | (between[i] != 0 ? flow::kSomewhere : 0));
    }
}

/// Joins the bits of each column with those `step` columns further.
inline void joinAhead(const std::uint8_t* __restrict bits, int step, int count, std::uint8_t* __restrict joined) {
    for (int i = 0; i < count; ++i) {
        joined[i] = bits[i] | bits[i + step];
    }
}

/// Adds the bits of the western and eastern sides to those of a block, for a block that begins at any column. `pairs`
/// holds each column joined with the next one.
inline void addSides(const std::uint8_t* __restrict columns, const std::uint8_t* __restrict pairs, int size, int count,
                     std::uint8_t* __restrict blocks) {
    for (int i = 0; i < count; ++i) {
        const int west = columns[i] != 0 ? flow::kWest : 0;
        const int east = pairs[i + size - 2] != 0 ? flow::kEast : 0;
        blocks[i] = static_cast<std::uint8_t>(blocks[i] | west | east);
    }
}

/// Writes where sand flows in each block of a piece of a run. All loops but the last one handle a vector of columns at
/// a time, because blocks are small.
inline void reportPiece(const Sweep& sweep, const RowBuffers& buffers, int northOfFirst, int from, int count,
                        std::uint8_t* blocks) {
    // Columns behind the piece hold 0.
    using Columns = std::array<std::uint8_t, kPiece + kMaxBlock>;
    Columns columns, pairs, joined, more;
    const int size = sweep.blockSize;
    joinRows(buffers.flowed[0] + from, buffers.flowed[1] + from, buffers.flowed[2] + from, northOfFirst, count,
             columns.data());
    for (Columns* const one : {&columns, &pairs, &joined, &more}) {
        std::fill_n(one->data() + count, size, std::uint8_t{0});
    }
    joinAhead(columns.data(), 1, count, pairs.data());
    std::copy_n(pairs.data(), count, joined.data());
    for (int width = 2; width < size;) {
        const int step = std::min(width, size - width);
        joinAhead(joined.data(), step, count, more.data());
        std::copy_n(more.data(), count, joined.data());
        width += step;
    }
    addSides(columns.data(), pairs.data(), size, count, joined.data());
    for (int x = 0; x < count; x += size) {
        *blocks++ = joined[static_cast<unsigned>(x)];
    }
    if (count % size != 0) {  // the last block is narrow, and pairs of its columns end earlier
        const std::uint8_t last =
            count % size == 1 ? columns[static_cast<unsigned>(count) - 1] : pairs[static_cast<unsigned>(count) - 2];
        blocks[-1] = static_cast<std::uint8_t>(blocks[-1] | (last != 0 ? flow::kEast : 0));
    }
}

inline constexpr int kShortBlock = 8;  // [cell], side of the blocks that reportShortRun() handles: a byte per column
inline constexpr int kShortRun = 64;   // [cell], a longer run is faster with vectors that cross blocks

/// Does the same as reportPiece() for whole blocks of eight columns. The bits of the columns are the bytes of one
/// number.
inline void reportShortRun(const RowBuffers& buffers, int northOfFirst, int from, int count, std::uint8_t* blocks) {
    static_assert(std::endian::native == std::endian::little, "the first column is the lowest byte");
    for (int x = from; x < from + count; x += kShortBlock) {
        std::array<std::uint8_t, kShortBlock> columns;
        joinRows(buffers.flowed[0] + x, buffers.flowed[1] + x, buffers.flowed[2] + x, northOfFirst, kShortBlock,
                 columns.data());
        const auto bits = __builtin_bit_cast(std::uint64_t, columns);
        std::uint64_t joined = bits | bits >> 32;
        joined |= joined >> 16;
        joined |= joined >> 8;
        const int west = (bits & 0xFF) != 0 ? flow::kWest : 0;
        const int east = bits >> (kShortBlock - 2) * 8 != 0 ? flow::kEast : 0;
        *blocks++ = static_cast<std::uint8_t>(joined | static_cast<unsigned>(west | east));
    }
}

/// Writes where sand flows in each block of a run.
inline void reportFlow(const Sweep& sweep, const RowBuffers& buffers, const BlockRow& row, const Run& run) {
    const int size = sweep.blockSize;
    const int northOfFirst = row.y1 - row.y0 <= 2 ? flow::kNorth : 0;  // the first row is one of the last two
    std::uint8_t* const blocks = sweep.flowed + row.y0 / size * sweep.flowedStride;
    const int width = run.x1 - run.x0;
    if (size == kShortBlock && width <= kShortRun && width % kShortBlock == 0) {
        reportShortRun(buffers, northOfFirst, run.x0, width, blocks + run.x0 / size);
        return;
    }
    const int piece = kPiece / size * size;
    for (int from = run.x0; from < run.x1; from += piece) {
        reportPiece(sweep, buffers, northOfFirst, from, std::min(piece, run.x1 - from), blocks + from / size);
    }
}

}  // namespace sand::grid::SANDWALL_CODE_PATH
