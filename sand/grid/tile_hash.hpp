// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/height_field.hpp"
#include "sand/model/surface.hpp"

namespace sand::grid {

inline constexpr int kHashTile = 32;  // [cell], side of a hash tile

/// Hash of all heights. An update costs only the changed tiles.
///
/// The hash is the sum, modulo 2^64, of one XXH3 hash per tile of 32 × 32 cells. A tile's index is its seed, so that
/// exchanged tiles do not cancel. The division into tiles is part of the definition. It does not follow the blocks of
/// Erosion.
class TileHash final : public HashTiles {
public:
    explicit TileHash(const HeightField& field);

    /// Marks the tiles that overlap `cells` as changed.
    void touch(const CellRect& cells);
    /// Hashes the changed tiles again. Returns the sum over all tiles.
    [[nodiscard]] std::uint64_t update(const HeightField& field);
    /// Hashes the next tile of the field again, whether or not it changed. Returns its index.
    int auditNext(const HeightField& field);
    /// Makes the hash of `tile` differ. Call it if the tile is corrupt in memory that its hash does not cover.
    void spoil(int tile);

    /// Returns the cells of `tile`. Tiles are numbered row by row from the south.
    [[nodiscard]] CellRect cellsOf(int tile) const override;

private:
    void rehash(const HeightField& field, int tile);

    int columns_, rows_, tilesAcross_;
    std::vector<std::uint8_t> dirty_;
    std::uint64_t sum_ = 0;
    int nextAudited_ = 0;
};

}  // namespace sand::grid
