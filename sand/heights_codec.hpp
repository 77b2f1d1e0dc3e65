// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "files/byte_stream.hpp"
#include "sand/height_field.hpp"

namespace sand {

/// Appends all heights, compressed without loss: for scenes, states and the journal.
void encodeHeights(const HeightField& field, files::ByteWriter& writer);

/// Reads them into a field of the same size. Throws files::FormatError for anything else, or a height out of range.
void decodeHeights(files::ByteReader& reader, HeightField& field);

}  // namespace sand
