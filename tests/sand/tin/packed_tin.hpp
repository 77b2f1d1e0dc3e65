// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zstd.h>

#include <cstdint>
#include <span>

#include "sand/tin/snapshot.hpp"

namespace fuzz {

inline base::Bytes compressed(std::span<const std::uint8_t> bytes) {
    base::Bytes packed(ZSTD_compressBound(bytes.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
    return packed;
}

/// Returns sand of a TIN: its TinState, and behind it the vertices. Throws base::FormatError if the bytes do not begin
/// with a TinState.
inline base::Bytes packedTin(base::ByteReader& plain) {
    const auto state = sand::tin::TinState::decode(plain);
    const auto rest = plain.getBytes(plain.rest().size());
    base::ByteWriter sand;
    state.encode(sand);
    sand.put(static_cast<std::uint64_t>(rest.size()));
    sand.putBytes(compressed(rest));
    return sand.take();
}

}  // namespace fuzz
