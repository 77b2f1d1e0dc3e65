// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>

#include "tests/fuzz/fuzz_target.hpp"

/// Makes PNG files out of chunks without lengths, checksums and compression. A flipped bit of a PNG would never reach
/// the code behind them.
namespace fuzz {

inline constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

inline void putBigEndian(std::uint32_t number, base::Bytes& bytes) {
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<std::uint8_t>(number >> shift));
    }
}

/// Appends a chunk. `chunk` has its type in four letters, then its data. The data of IDAT is compressed if `deflates`.
inline void putChunk(Input chunk, bool deflates, base::Bytes& png) {
    base::Bytes body(chunk.begin(), chunk.end());
    if (deflates && textOf(chunk).substr(0, 4) == "IDAT") {
        uLongf length = compressBound(static_cast<uLong>(chunk.size()));
        body.resize(4 + length);
        compress(body.data() + 4, &length, chunk.data() + 4, static_cast<uLong>(chunk.size() - 4));
        body.resize(4 + length);
    }
    putBigEndian(static_cast<std::uint32_t>(body.size() - 4), png);
    png.insert(png.end(), body.begin(), body.end());
    putBigEndian(static_cast<std::uint32_t>(crc32(0, body.data(), static_cast<uInt>(body.size()))), png);
}

/// Returns a PNG whose chunks are the pieces of the input.
inline base::Bytes pngOf(Input input, bool deflates) {
    base::Bytes png(kPngSignature.begin(), kPngSignature.end());
    for (const Input chunk : piecesOf(input)) {
        if (chunk.size() >= 4) {
            putChunk(chunk, deflates, png);
        }
    }
    return png;
}

}  // namespace fuzz
