// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sand/grid/inertia.hpp"
#include "sand/grid/snapshot.hpp"
#include "sand/model/height_field.hpp"

namespace sand::grid {

/// Sand before a stroke, kept for an undo.
///
/// keep() copies no heights. A tile is copied before a drag, a sweep or an edit first visits it after that. So the
/// first step of a stroke on a large field takes no longer than any other. The memory is four bytes for each cell of
/// these tiles. After a change of the rules and after resume(), a sweep visits all tiles once. Not thread-safe.
class Undo {
public:
    static constexpr int kTile = 64;  // side of a tile [cell]

    /// Keeps the sand of `field`.
    void keep(const HeightField& field, Inertia inertia, std::int64_t outflow);
    /// Keeps the sand of `copy`, which may differ from `field`.
    void keep(const Snapshot& copy, const HeightField& field);
    /// Drops the kept sand.
    void forget() { kept_.reset(); }
    [[nodiscard]] bool any() const { return kept_.has_value(); }

    /// Must be called before heights in `cells` of `field` change.
    void willChange(const HeightField& field, const CellRect& cells);
    /// Returns a copy of the kept sand. Requires any(). `field` is the current sand.
    [[nodiscard]] Snapshot copy(const HeightField& field) const;
    /// Returns the height of a cell in the kept sand [unit]. Requires any().
    [[nodiscard]] std::int32_t height(const HeightField& field, int column, int row) const;
    /// Fluxes and outflow of the kept sand. Requires any().
    [[nodiscard]] const Inertia& inertia() const { return kept_->inertia; }
    [[nodiscard]] std::int64_t outflow() const { return kept_->outflow; }
    /// Writes the kept heights back into `field`, and returns the cells that may have changed. Requires any().
    [[nodiscard]] std::vector<CellRect> putBackHeights(HeightField& field);

private:
    struct Kept {
        Inertia inertia;
        std::int64_t outflow;  // [unit · cell]
        int tilesAcross;
        // Heights of each tile, row by row; empty for a tile whose heights are those of the field [unit].
        std::vector<std::vector<std::int32_t>> tiles;

        [[nodiscard]] CellRect cellsOf(std::size_t tile, const HeightField& field) const;
        void putInto(HeightField& field) const;
    };
    std::optional<Kept> kept_;
};

}  // namespace sand::grid
