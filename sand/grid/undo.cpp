// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/undo.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace sand::grid {

void Undo::Kept::putInto(HeightField& field) const {
    for (const std::shared_ptr<const PackedCells>& tile : tiles) {
        if (tile != nullptr) {
            tile->putInto(field.cells());
        }
    }
}

void Undo::keep(const HeightField& field, Inertia inertia, std::int64_t outflow) {
    kept_.reset();  // until all memory is there
    Kept kept{std::move(inertia), outflow, TileGrid(field.bounds()), {}};
    kept.tiles.resize(kept.grid.count());
    kept_ = std::move(kept);
}

void Undo::keep(const Snapshot& copy, const HeightField& field) {
    keep(field, copy.inertia, copy.outflow);
    Kept kept = std::move(*kept_);
    kept_.reset();
    for (std::size_t tile = 0; tile < kept.tiles.size(); ++tile) {
        const CellRect cells = kept.grid.cellsOf(tile);
        bool differs = false;
        for (int y = cells.y0; y < cells.y1; ++y) {
            differs = differs ||
                      !std::equal(copy.field.row(y) + cells.x0, copy.field.row(y) + cells.x1, field.row(y) + cells.x0);
        }
        if (differs) {
            kept.tiles[tile] = std::make_shared<const PackedCells>(copy.field.cells(), cells);
        }
    }
    kept_ = std::move(kept);
}

void Undo::willChange(const HeightField& field, const CellRect& cells) {
    if (!kept_) {
        return;
    }
    kept_->grid.forEach(cells, [&](std::size_t tile) {
        willChangeTile(tile,
                       [&] { return std::make_shared<const PackedCells>(field.cells(), kept_->grid.cellsOf(tile)); });
    });
}

Snapshot Undo::copy(const HeightField& field) const {
    Snapshot copy(field, kept_->inertia, kept_->outflow);
    kept_->putInto(copy.field);
    return copy;
}

std::int32_t Undo::height(const HeightField& field, int column, int row) const {
    const std::shared_ptr<const PackedCells>& tile = kept_->tiles[kept_->grid.tileAt(column, row)];
    if (tile == nullptr) {
        return field.height(column, row);
    }
    if (kept_->read != tile) {
        kept_->numbers = tile->numbers();
        kept_->read = tile;
    }
    const CellRect& cells = tile->cells();
    return kept_->numbers[static_cast<std::size_t>(row - cells.y0) * static_cast<std::size_t>(cells.x1 - cells.x0) +
                          static_cast<std::size_t>(column - cells.x0)];
}

std::vector<CellRect> Undo::changed() const {
    std::vector<CellRect> cells;
    for (const std::shared_ptr<const PackedCells>& tile : kept_->tiles) {
        if (tile != nullptr) {
            cells.push_back(tile->cells());
        }
    }
    return cells;
}

void Undo::putBackHeights(HeightField& field) {
    kept_->putInto(field);
    kept_->tiles.assign(kept_->tiles.size(), nullptr);
    kept_->read = nullptr;  // gives its memory back
    kept_->numbers = {};
}

}  // namespace sand::grid
