// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sand/model/height_field.hpp"
#include "sand/model/movement.hpp"
#include "sand/model/surface.hpp"

namespace sand::grid {

/// Hash of all heights. An update costs only the changed tiles.
///
/// The hash is the sum, modulo 2^64, of one XXH3 hash per tile of 32 × 32 cells. A tile's index is its seed, so that
/// exchanged tiles do not cancel. The division into tiles is part of the definition. It does not follow the blocks of
/// Erosion.
class TileHash final : public HashTiles {
public:
    explicit TileHash(const HeightField& field);

    /// Marks the tiles that overlap `cells`, because they may have changed.
    void touch(const CellRect& cells);
    /// Hashes the marked tiles again, and calls `changed` with each tile whose hash is another one. Which tiles
    /// are marked may depend on how the sand is swept. Which tiles have changed does not.
    void update(const HeightField& field, const std::function<void(int)>& changed);
    /// Returns the sum over all tiles at the last update.
    [[nodiscard]] std::uint64_t sum() const { return sum_; }
    /// Hashes the next tile of the field again, whether or not it changed. Returns its index.
    int auditNext(const HeightField& field);
    /// Makes the hash of `tile` differ. Call it if the tile is corrupt in memory that its hash does not cover.
    void spoil(int tile);

    /// Returns the cells of `tile`. Tiles are numbered row by row from the south.
    [[nodiscard]] CellRect cellsOf(int tile) const override;

private:
    /// Hashes a tile again. Returns whether its hash has changed.
    bool rehash(const HeightField& field, int tile);

    int columns_, rows_, tilesAcross_;
    std::vector<std::uint8_t> dirty_;
    std::uint64_t sum_ = 0;
    int nextAudited_ = 0;
};

}  // namespace sand::grid
