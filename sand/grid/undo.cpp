// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/undo.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace sand::grid {
namespace {

int tilesIn(int cells) { return (cells + Undo::kTile - 1) / Undo::kTile; }

std::vector<std::int32_t> heightsOf(const HeightField& field, const CellRect& cells) {
    std::vector<std::int32_t> heights;
    heights.reserve(static_cast<std::size_t>(cells.x1 - cells.x0) * static_cast<std::size_t>(cells.y1 - cells.y0));
    for (int y = cells.y0; y < cells.y1; ++y) {
        heights.insert(heights.end(), field.row(y) + cells.x0, field.row(y) + cells.x1);
    }
    return heights;
}

}  // namespace

CellRect Undo::Kept::cellsOf(std::size_t tile, const HeightField& field) const {
    const int x = static_cast<int>(tile) % tilesAcross * kTile, y = static_cast<int>(tile) / tilesAcross * kTile;
    return CellRect{x, y, x + kTile, y + kTile}.clippedTo(field.bounds());
}

void Undo::Kept::putInto(HeightField& field) const {
    for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
        if (tiles[tile].empty()) {
            continue;
        }
        const CellRect cells = cellsOf(tile, field);
        auto heights = tiles[tile].begin();
        for (int y = cells.y0; y < cells.y1; ++y) {
            std::copy_n(heights, cells.x1 - cells.x0, field.row(y) + cells.x0);
            heights += cells.x1 - cells.x0;
        }
    }
}

void Undo::keep(const HeightField& field, Inertia inertia, std::int64_t outflow) {
    kept_.reset();  // until all memory is there
    Kept kept{std::move(inertia), outflow, tilesIn(field.columns()), {}};
    kept.tiles.resize(static_cast<std::size_t>(kept.tilesAcross) * static_cast<std::size_t>(tilesIn(field.rows())));
    kept_ = std::move(kept);
}

void Undo::keep(const Snapshot& copy, const HeightField& field) {
    keep(field, copy.inertia, copy.outflow);
    Kept kept = std::move(*kept_);
    kept_.reset();
    for (std::size_t tile = 0; tile < kept.tiles.size(); ++tile) {
        const CellRect cells = kept.cellsOf(tile, field);
        if (std::vector<std::int32_t> heights = heightsOf(copy.field, cells); heights != heightsOf(field, cells)) {
            kept.tiles[tile] = std::move(heights);
        }
    }
    kept_ = std::move(kept);
}

void Undo::willChange(const HeightField& field, const CellRect& cells) {
    const CellRect inside = cells.clippedTo(field.bounds());
    if (!kept_ || inside.empty()) {
        return;
    }
    for (int y = inside.y0 / kTile; y < tilesIn(inside.y1); ++y) {
        for (int x = inside.x0 / kTile; x < tilesIn(inside.x1); ++x) {
            const auto tile = static_cast<std::size_t>(y * kept_->tilesAcross + x);
            if (kept_->tiles[tile].empty()) {
                kept_->tiles[tile] = heightsOf(field, kept_->cellsOf(tile, field));
            }
        }
    }
}

Snapshot Undo::copy(const HeightField& field) const {
    Snapshot copy(field, kept_->inertia, kept_->outflow);
    kept_->putInto(copy.field);
    return copy;
}

std::int32_t Undo::height(const HeightField& field, int column, int row) const {
    const auto tile = static_cast<std::size_t>(row / kTile * kept_->tilesAcross + column / kTile);
    if (kept_->tiles[tile].empty()) {
        return field.height(column, row);
    }
    const CellRect cells = kept_->cellsOf(tile, field);
    const int place = (row - cells.y0) * (cells.x1 - cells.x0) + column - cells.x0;
    return kept_->tiles[tile][static_cast<std::size_t>(place)];
}

std::vector<CellRect> Undo::putBackHeights(HeightField& field) {
    kept_->putInto(field);
    std::vector<CellRect> changed;
    for (std::size_t tile = 0; tile < kept_->tiles.size(); ++tile) {
        if (!std::exchange(kept_->tiles[tile], {}).empty()) {
            changed.push_back(kept_->cellsOf(tile, field));
        }
    }
    return changed;
}

}  // namespace sand::grid
