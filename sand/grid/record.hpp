// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "sand/grid/inertia.hpp"
#include "sand/grid/packed_cells.hpp"
#include "sand/grid/tile_grid.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/surface_record.hpp"

namespace sand::grid {

/// Record of a height field: the heights of the tiles that have changed since its moment. Tiles never change, so
/// records and the undo of a stroke share them.
class Record final : public SurfaceRecord {
public:
    using Tile = std::shared_ptr<const PackedCells>;  // null: as in the field, or in a later record

    Record(std::size_t tiles, Inertia inertia, std::int64_t outflow /* [unit · cell] */)
        : tiles_(tiles), inertia_(std::move(inertia)), outflow_(outflow) {}

    static Record& of(SurfaceRecord& record) { return dynamic_cast<Record&>(record); }
    static const Record& of(const SurfaceRecord& record) { return dynamic_cast<const Record&>(record); }

    [[nodiscard]] std::int64_t bytes() const override {
        return heights_ + inertia_.bytes() + static_cast<std::int64_t>(tiles_.size() * sizeof(Tile));
    }
    [[nodiscard]] std::shared_ptr<SurfaceRecord> withoutParts() const override {
        return std::make_shared<Record>(tiles_.size(), inertia_, outflow_);
    }

    [[nodiscard]] const std::vector<Tile>& tiles() const { return tiles_; }
    [[nodiscard]] const Inertia& inertia() const { return inertia_; }
    [[nodiscard]] std::int64_t outflow() const { return outflow_; }

    void put(std::size_t tile, Tile heights) {
        heights_ += (heights != nullptr ? heights->bytes() : 0) - (tiles_[tile] != nullptr ? tiles_[tile]->bytes() : 0);
        tiles_[tile] = std::move(heights);
    }
    /// Must be called before heights of a tile change. `pack` returns the tile's heights.
    template <class Pack>
    void willChangeTile(std::size_t tile, const Pack& pack) {
        if (tiles_[tile] == nullptr) {
            put(tile, pack());
        }
    }
    /// Forgets the tiles whose heights `field` has again.
    void forgetEqual(const HeightField& field) {
        for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
            if (tiles_[tile] != nullptr && *tiles_[tile] == PackedCells(field.cells(), tiles_[tile]->cells())) {
                put(tile, nullptr);
            }
        }
    }

private:
    std::vector<Tile> tiles_;
    Inertia inertia_;
    std::int64_t outflow_;      // [unit · cell]
    std::int64_t heights_ = 0;  // [byte], of all tiles
};

}  // namespace sand::grid
