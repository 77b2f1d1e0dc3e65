// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/byte_stream.hpp"
#include "sand/model/cell_array.hpp"

namespace sand {

/// Appends the numbers of `cells` to `writer`, compressed without loss. `cells` may include ghost cells. Scenes, states
/// and the journal use this format.
void encodeCells(const CellArray& grid, const CellRect& cells, base::ByteWriter& writer);

/// Reads what encodeCells() wrote for the same `cells` of a grid of the same size. Throws base::FormatError for other
/// bytes, or if a number is beyond ±`most`.
void decodeCells(base::ByteReader& reader, const CellRect& cells, std::int32_t most, CellArray& grid);

}  // namespace sand
