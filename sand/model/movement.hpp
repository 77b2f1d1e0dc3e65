// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/byte_stream.hpp"

namespace sand {

inline constexpr int kHashTile = 32;  // [cell], side of a hash tile of a height field

/// Returns the number of hash tiles along a side of so many cells.
[[nodiscard]] constexpr int hashTilesAlong(int cells) { return (cells + kHashTile - 1) / kHashTile; }

/// The steps in which the sand of a height field moved last, by hash tile. Drawing shows moving sand more coarsely.
///
/// Replicas that have applied the same steps have equal numbers, also if they began with a state. The state hash does
/// not cover them. They have a digest of their own.
struct Movement {
    std::uint64_t step = 0;    // number of the last step
    std::uint64_t newest = 0;  // largest of `moved`
    /// Number of the last step that changed a height in each hash tile; 0 if none has since the sand was made.
    std::vector<std::uint64_t> moved;

    /// Records that the current step has changed a height in hash tile `tile`.
    void add(int tile) {
        moved[static_cast<std::size_t>(tile)] = step;
        newest = step;
    }

    /// Returns a hash of `moved`, computed from memory.
    [[nodiscard]] std::uint64_t digest() const;
    /// Appends `moved` as runs of equal numbers: length and number of each run as varints.
    void encode(base::ByteWriter& writer) const;
    /// Returns what encode() wrote after step `step` for sand with `tiles` hash tiles. Throws base::FormatError if the
    /// bytes are not the numbers of all hash tiles, or if a number is greater than `step`.
    [[nodiscard]] static Movement decode(std::span<const std::uint8_t> bytes, std::uint64_t step, std::size_t tiles);
};

}  // namespace sand
