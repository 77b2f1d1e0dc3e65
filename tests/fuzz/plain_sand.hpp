// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "scene/model/scene.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/sand/tin/packed_tin.hpp"

/// Makes the compressed bytes of sand and states out of plain ones.
namespace fuzz {

/// Reads as many bytes as there are, and zeros instead of the rest.
inline base::Bytes takeOrZeros(base::ByteReader& plain, std::size_t count) {
    const auto there = plain.getBytes(std::min(count, plain.rest().size()));
    base::Bytes bytes(there.begin(), there.end());
    bytes.resize(count, 0);
    return bytes;
}

/// Returns sand of a height field: outflow, heights, age of the inertia, and fluxes if the byte before them is odd.
inline base::Bytes packedGrid(base::ByteReader& plain, int columns, int rows) {
    base::ByteWriter sand;
    sand.putBytes(takeOrZeros(plain, sizeof(std::int64_t)));
    const auto cells = [&](int x, int y) {
        sand.putBlock(compressed(takeOrZeros(plain, static_cast<std::size_t>(x) * static_cast<std::size_t>(y) * 4)));
    };
    cells(columns, rows);
    sand.putBytes(takeOrZeros(plain, sizeof(std::int32_t)));
    const std::uint8_t flows = takeOrZeros(plain, 1)[0] & 1U;
    sand.put(flows);
    if (flows == 1) {
        cells(columns + 1, rows + 1);
        cells(columns + 1, rows + 1);
    }
    return sand.take();
}

inline base::Bytes packedSand(base::ByteReader& plain, const scene::Scene& scene) {
    return scene.tin != nullptr ? packedTin(plain) : packedGrid(plain, scene.rules.columns, scene.rules.rows);
}

/// Returns a state: its head and its movement, each with a length before it, the sand that is kept for an undo with a
/// length before it (0: no sand is kept), and the sand. The kind of `scene` decides how both are read.
inline base::Bytes packedState(Input plain, const scene::Scene& scene) {
    base::ByteReader reader(plain);
    const auto part = [&reader] { return reader.getBytes(reader.get<std::uint16_t>()); };
    base::ByteWriter state;
    state.putBytes(part());
    state.putBlock(part());
    const auto kept = part();
    base::ByteReader keptReader(kept);
    state.putBlock(kept.empty() ? base::Bytes() : packedSand(keptReader, scene));
    state.putBytes(packedSand(reader, scene));
    return state.take();
}

}  // namespace fuzz
