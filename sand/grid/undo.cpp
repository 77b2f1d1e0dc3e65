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
    Kept kept{{std::move(inertia), outflow}, TileGrid(field.bounds()), {}};
    kept.tiles.resize(kept.grid.count());
    kept_ = std::move(kept);
}

Undo Undo::decode(std::span<const std::uint8_t> bytes, const SandLimits& limits, const HeightField& field,
                  const std::function<void(std::size_t)>& decoded) {
    Kept kept{{}, TileGrid(field.bounds()), {}};
    kept.tiles.resize(kept.grid.count());
    CellArray window(field.columns(), kTile);  // rows [first, first + kTile)
    const auto keepRowOfTiles = [&](int first) {
        kept.grid.forEach({0, first, field.columns(), first + 1}, [&](std::size_t tile) {
            const CellRect cells = kept.grid.cellsOf(tile);
            bool differs = false;
            for (int y = cells.y0; y < cells.y1 && !differs; ++y) {
                const std::int32_t* const row = window.row(y - first);
                differs = !std::equal(row + cells.x0, row + cells.x1, field.row(y) + cells.x0);
            }
            if (differs) {
                kept.tiles[tile] = std::make_shared<const PackedCells>(window, cells, first);
            }
        });
    };
    const auto rowOf = [&window](int y) { return window.row(y % kTile); };
    const auto done = [&](int y) {
        if ((y + 1) % kTile == 0 || y + 1 == field.rows()) {
            keepRowOfTiles(y / kTile * kTile);
        }
    };
    kept.rest = decodeSand(bytes, limits, {rowOf, done}, decoded);
    Undo undo;
    undo.kept_ = std::move(kept);
    return undo;
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

void Undo::encodeInto(const HeightField& field, base::ByteWriter& writer) const {
    const CellRect bounds = field.bounds();
    CellArray window(field.columns(), kTile);
    int first = -1;        // row of the field that row 0 of the window has
    bool differs = false;  // whether a tile in these rows does
    const auto rowOf = [&](int y) -> const std::int32_t* {
        if (const int wanted = y / kTile * kTile; wanted != first) {
            first = wanted;
            differs = false;
            kept_->grid.forEach({0, first, bounds.x1, first + 1},
                                [&](std::size_t tile) { differs = differs || kept_->tiles[tile] != nullptr; });
            for (int row = first; differs && row < std::min(first + kTile, bounds.y1); ++row) {
                std::copy(field.row(row), field.row(row) + bounds.x1, window.row(row - first));
            }
            kept_->grid.forEach({0, first, bounds.x1, first + 1}, [&](std::size_t tile) {
                if (kept_->tiles[tile] != nullptr) {
                    kept_->tiles[tile]->putInto(window, first, first + kTile, 0);
                }
            });
        }
        return differs ? window.row(y - first) : field.row(y);
    };
    encodeSand(bounds, rowOf, kept_->rest, writer, {});
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
