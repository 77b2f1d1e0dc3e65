// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sand/grid/inertia.hpp"
#include "sand/grid/packed_cells.hpp"
#include "sand/grid/snapshot.hpp"
#include "sand/grid/tile_grid.hpp"
#include "sand/model/height_field.hpp"

namespace sand::grid {

/// Sand before a stroke, kept for an undo.
///
/// keep() copies no heights. A tile is copied before a drag, a sweep or an edit first visits it after that. So the
/// first step of a stroke on a large field takes no longer than any other. The tiles are packed: steep sand takes about
/// two bytes for each of their cells. After a change of the rules and after resume(), a sweep visits all tiles once.
/// Not thread-safe.
class Undo {
public:
    static constexpr int kTile = TileGrid::kTile;  // side of a tile [cell]

    /// Keeps the sand of `field`.
    void keep(const HeightField& field, Inertia inertia, std::int64_t outflow);
    /// Returns an Undo that keeps the sand of `bytes`, which encodeInto() wrote. `field` is the current sand. Throws as
    /// decodeSand() does. Takes memory for the tiles that differ from `field`, and for one row of tiles.
    [[nodiscard]] static Undo decode(std::span<const std::uint8_t> bytes, const SandLimits& limits,
                                     const HeightField& field, const std::function<void(std::size_t)>& decoded = {});
    /// Drops the kept sand.
    void forget() { kept_.reset(); }
    [[nodiscard]] bool any() const { return kept_.has_value(); }

    /// Must be called before heights in `cells` of `field` change.
    void willChange(const HeightField& field, const CellRect& cells);
    /// Must be called before heights of a tile change, in place of willChange(). `pack` returns the tile's heights.
    template <class Pack>
    void willChangeTile(std::size_t tile, const Pack& pack) {
        if (kept_ && kept_->tiles[tile] == nullptr) {
            kept_->tiles[tile] = pack();
        }
    }
    /// Writes the kept sand as Snapshot::encodeInto() does. Requires any(). `field` is the current sand.
    void encodeInto(const HeightField& field, base::ByteWriter& writer) const;
    /// Returns the height of a cell in the kept sand [unit]. Requires any(). Unpacks a tile only if the last call has
    /// asked for another one.
    [[nodiscard]] std::int32_t height(const HeightField& field, int column, int row) const;
    /// Returns the heights of each tile of the kept sand; null for a tile whose heights are those of the field.
    /// Requires any(). The tiles never change, so they may be shared.
    [[nodiscard]] const std::vector<std::shared_ptr<const PackedCells>>& tiles() const { return kept_->tiles; }
    /// Fluxes and outflow of the kept sand. Requires any().
    [[nodiscard]] const Inertia& inertia() const { return kept_->rest.inertia; }
    [[nodiscard]] std::int64_t outflow() const { return kept_->rest.outflow; }
    /// Returns the cells that putBackHeights() may change. Requires any().
    [[nodiscard]] std::vector<CellRect> changed() const;
    /// Writes the kept heights back into `field`. The kept sand is then that of the field. Requires any().
    void putBackHeights(HeightField& field);

private:
    struct Kept {
        SandRest rest;
        TileGrid grid;
        std::vector<std::shared_ptr<const PackedCells>> tiles;
        /// The tile that height() has unpacked last, and its numbers. A ray reads many cells of a tile, one by one.
        mutable std::shared_ptr<const PackedCells> read{};
        mutable std::vector<std::int32_t> numbers{};

        void putInto(HeightField& field) const;
    };
    std::optional<Kept> kept_;
};

}  // namespace sand::grid
