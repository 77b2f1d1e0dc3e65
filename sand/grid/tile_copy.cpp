// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/tile_copy.hpp"

#include <functional>
#include <utility>

#include "sand/model/grid_codec.hpp"

namespace sand::grid {
namespace {

using HeightsOf = std::function<const PackedCells&(std::size_t tile)>;

/// Writes what Snapshot::encodeInto() writes. Unpacks one row of tiles at a time.
void encodeTiles(const TileGrid& grid, const HeightsOf& heightsOf, const SandRest& rest, base::ByteWriter& writer,
                 const std::function<void()>& between) {
    const CellRect& field = grid.field();
    CellArray window(field.x1, TileGrid::kTile);
    int first = -1;  // row of the field that row 0 of the window has
    const auto rowOf = [&](int y) -> const std::int32_t* {
        if (const int wanted = y / TileGrid::kTile * TileGrid::kTile; wanted != first) {
            first = wanted;
            grid.forEach({0, first, field.x1, first + 1},
                         [&](std::size_t tile) { heightsOf(tile).putInto(window, first, first + TileGrid::kTile, 0); });
        }
        return window.row(y - first);
    };
    encodeSand(field, rowOf, rest, writer, between);
}

std::size_t stripesOfTiles(const TileGrid& grid, const Inertia& inertia) {
    return stripesOf(grid.field()) + inertia.stripes(grid.field().x1, grid.field().y1);
}

}  // namespace

TileCopy::TileCopy(const HeightField& field, const Erosion& erosion, std::int64_t outflow)
    : grid_(field.bounds()),
      heights_(grid_.count()),
      flows_(erosion.tilesWithFlux(grid_)),
      inertia_(erosion.undisturbed()),
      outflow_(outflow),
      left_(grid_.count()) {}

void TileCopy::take(const HeightField& field, const Erosion& erosion, std::size_t tile) {
    const CellRect cells = grid_.cellsOf(tile);
    auto heights = std::make_unique<const PackedCells>(field.cells(), cells);
    if (flows_[tile]) {
        erosion.addFluxes(cells, inertia_);
    }
    heights_[tile] = std::move(heights);
    --left_;
}

void TileCopy::willChange(const HeightField& field, const Erosion& erosion, const CellRect& cells) {
    grid_.forEach(cells, [&](std::size_t tile) {
        if (heights_[tile] == nullptr) {
            take(field, erosion, tile);
        }
    });
}

void TileCopy::copyMore(const HeightField& field, const Erosion& erosion, std::int64_t cells) {
    for (; next_ < heights_.size() && cells > 0; ++next_) {
        if (heights_[next_] == nullptr) {
            const CellRect tile = grid_.cellsOf(next_);
            take(field, erosion, next_);
            cells -= std::int64_t{tile.x1 - tile.x0} * (tile.y1 - tile.y0);
        }
    }
}

void TileCopy::encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const {
    encodeTiles(
        grid_, [this](std::size_t tile) -> const PackedCells& { return heights(tile); }, {inertia_, outflow_}, writer,
        between);
}

std::size_t TileCopy::stripes() const { return stripesOfTiles(grid_, inertia_); }

KeptCopy::KeptCopy(Tiles tiles, Inertia inertia, std::int64_t outflow, std::shared_ptr<const TileCopy> now)
    : heights_(std::move(tiles)), inertia_(std::move(inertia)), outflow_(outflow), now_(std::move(now)) {}

void KeptCopy::encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const {
    const auto heightsOf = [this](std::size_t tile) -> const PackedCells& {
        return heights_[tile] != nullptr ? *heights_[tile] : now_->heights(tile);
    };
    encodeTiles(now_->grid(), heightsOf, {inertia_, outflow_}, writer, between);
}

std::size_t KeptCopy::stripes() const { return stripesOfTiles(now_->grid(), inertia_); }

}  // namespace sand::grid
