// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/byte_stream.hpp"
#include "sand/model/cell_array.hpp"

namespace sand {

/// Appends these cells, ghosts among them if wanted, compressed without loss: for scenes, states and the journal.
void encodeCells(const CellArray& grid, const CellRect& cells, base::ByteWriter& writer);

/// Reads them into the same cells of a grid of the same size. Throws base::FormatError for anything else, or a number
/// beyond ±`most`.
void decodeCells(base::ByteReader& reader, const CellRect& cells, std::int32_t most, CellArray& grid);

}  // namespace sand
