// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/height_field.hpp"
#include "sand/model/surface.hpp"

namespace sand::grid {

inline constexpr int kHashTile = 32;  // [cell], side of a hash tile

/// A hash of all heights that costs only what changed: one XXH3 per 32×32 tile, summed modulo 2^64.
///
/// A tile's index is its seed, so that exchanged tiles do not cancel. The tiling is part of the definition and does
/// not follow the blocks that erosion works in.
class TileHash final : public HashTiles {
public:
    explicit TileHash(const HeightField& field);

    /// Marks the tiles that overlap `cells` as changed.
    void touch(const CellRect& cells);
    /// Hashes the changed tiles, and returns the sum over all.
    [[nodiscard]] std::uint64_t update(const HeightField& field);
    /// Hashes the next tile again, in turn over the field, whether or not it changed; returns which it was.
    int auditNext(const HeightField& field);
    /// The tile is known to be corrupt somewhere that its hash does not reach: makes it differ.
    void spoil(int tile);

    /// Tiles go row by row, south first.
    [[nodiscard]] CellRect cellsOf(int tile) const override;

private:
    void rehash(const HeightField& field, int tile);

    int columns_, rows_, tilesAcross_;
    std::vector<std::uint8_t> dirty_;
    std::uint64_t sum_ = 0;
    int nextAudited_ = 0;
};

}  // namespace sand::grid
