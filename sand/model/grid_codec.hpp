// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "base/byte_stream.hpp"
#include "sand/model/cell_array.hpp"

namespace sand {

/// Most numbers in a stripe, unless a row has more.
inline constexpr std::size_t kStripe = std::size_t{1} << 20;

/// Appends the numbers of `cells` to `writer`, compressed without loss. `cells` may include ghost cells. Scenes, states
/// and the journal use this format: a block of zstd frames, each with a stripe of whole rows. Needs memory for a stripe
/// and for the compressed bytes. Calls `between` after each stripe, unless it is empty. It may throw, in order to stop.
void encodeCells(const CellArray& grid, const CellRect& cells, base::ByteWriter& writer,
                 const std::function<void()>& between = {});

/// Writes the same for cells whose rows are given one after another. `rowOf(row)` returns a pointer to cell 0 of the
/// row, which is valid until its next call.
void encodeRows(const CellRect& cells, const std::function<const std::int32_t*(int row)>& rowOf,
                base::ByteWriter& writer, const std::function<void()>& between = {});

/// Returns what encodeCells() writes.
[[nodiscard]] std::shared_ptr<const base::Bytes> packedCells(const CellArray& grid, const CellRect& cells,
                                                             const std::function<void()>& between = {});

/// Appends what packedCells() has returned.
void encodePacked(const base::Bytes& packed, base::ByteWriter& writer);

/// Throws base::FormatError if so few compressed bytes come next that no `cells` cells can be in them. Code that takes
/// the size of a grid from outside calls it before it makes the grid.
void requireCells(base::ByteReader reader, std::size_t cells);

/// The rows of a grid that decodeRows() reads.
struct RowsToDecode {
    std::function<std::int32_t*(int y)> rowOf;  // returns the place for the numbers of a row
    std::function<void(int y)> done{};          // called when a row has its numbers; may be empty, and may throw
};
/// Reads what encodeCells() wrote for `cells`, row by row, as decodeCells() does. The grid need not be in memory.
void decodeRows(base::ByteReader& reader, const CellRect& cells, std::int32_t most, const RowsToDecode& take,
                const std::function<void(std::size_t)>& decoded = {});

/// Reads what encodeCells() wrote for the same `cells` of a grid of the same size. Throws base::FormatError for other
/// bytes, or if a number is beyond ±`most`; `cells` then have unspecified numbers. Also reads one frame of all rows, as
/// earlier builds wrote it. Calls `decoded` after each stripe, unless it is empty, with the number of packed bytes that
/// were unpacked since the last call.
void decodeCells(base::ByteReader& reader, const CellRect& cells, std::int32_t most, CellArray& grid,
                 const std::function<void(std::size_t)>& decoded = {});

/// Returns the number of stripes of encodeCells().
[[nodiscard]] std::size_t stripesOf(const CellRect& cells);

}  // namespace sand
