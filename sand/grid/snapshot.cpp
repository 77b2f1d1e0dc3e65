// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/snapshot.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "sand/model/grid_codec.hpp"

namespace sand::grid {
namespace {

constexpr int kTile = 64;  // [cell]

int tilesIn(int cells) { return (cells + kTile - 1) / kTile; }

/// Throws unless volume and outflow are possible for a field whose heights are within ±kMaxHeight.
void requirePossible(const Snapshot& copy) {
    const std::int64_t most =
        std::int64_t{kMaxHeight} * copy.field.columns() * copy.field.rows();  // [unit · cell], at most 2^56
    const bool possible = copy.outflow >= -2 * most && copy.outflow <= 2 * most;
    if (!possible || std::abs(copy.field.volume() + copy.outflow) > most) {
        throw base::FormatError("sand whose outflow is more than all of its sand");
    }
}

/// Throws if the surface of the sand lies below rock. Sand of negative thickness would draw sand out of its neighbours
/// until heights overflow.
void requireAbove(const Ground& ground, const HeightField& field) {
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            if (ground.sand(x, y, field.height(x, y)) < 0) {
                throw base::FormatError("rock above the sand that lies on it");
            }
        }
    }
}

void copyCells(const HeightField& from, const CellRect& cells, HeightField& to) {
    for (int y = cells.y0; y < cells.y1; ++y) {
        std::copy(from.row(y) + cells.x0, from.row(y) + cells.x1, to.row(y) + cells.x0);
    }
}

}  // namespace

base::Bytes Snapshot::encode() const {
    base::ByteWriter writer;
    writer.put(outflow);
    encodeCells(field.cells(), field.bounds(), writer);
    inertia.encode(field.columns(), field.rows(), writer);
    return writer.take();
}

Snapshot Snapshot::decode(std::span<const std::uint8_t> bytes, const SandLimits& limits) {
    base::ByteReader reader(bytes);
    const auto outflow = reader.get<std::int64_t>();
    Snapshot copy(HeightField(limits.faces.columns, limits.faces.rows, limits.cellSize), {}, outflow);
    decodeCells(reader, copy.field.bounds(), kMaxHeight, copy.field.cells());
    requirePossible(copy);
    if (limits.ground != nullptr) {
        requireAbove(*limits.ground, copy.field);
    }
    copy.inertia = Inertia::decode(reader, limits.faces);
    if (!reader.atEnd()) {
        throw base::FormatError("sand with further bytes behind it");
    }
    return copy;
}

void Undo::touch(const CellRect& cells) {
    if (!copy_) {
        return;
    }
    const CellRect inside = cells.clippedTo(copy_->field.bounds());
    if (inside.empty()) {
        return;
    }
    for (int y = inside.y0 / kTile; y < tilesIn(inside.y1); ++y) {
        std::fill_n(touched_.begin() + y * tilesAcross_ + inside.x0 / kTile, tilesIn(inside.x1) - inside.x0 / kTile,
                    std::uint8_t{1});
    }
}

std::vector<CellRect> Undo::takeTouched() {
    std::vector<CellRect> tiles;
    for (std::size_t i = 0; i < touched_.size(); ++i) {
        if (std::exchange(touched_[i], std::uint8_t{0}) != 0) {
            const int x = static_cast<int>(i) % tilesAcross_ * kTile;
            const int y = static_cast<int>(i) / tilesAcross_ * kTile;
            tiles.push_back(CellRect{x, y, x + kTile, y + kTile}.clippedTo(copy_->field.bounds()));
        }
    }
    return tiles;
}

void Undo::keep(const HeightField& field, Inertia inertia, std::int64_t outflow) {
    if (!copy_) {
        copy_.emplace(field, std::move(inertia), outflow);
        tilesAcross_ = tilesIn(field.columns());
        touched_.assign(static_cast<std::size_t>(tilesAcross_) * static_cast<std::size_t>(tilesIn(field.rows())), 0);
    } else {
        for (const CellRect& tile : takeTouched()) {
            copyCells(field, tile, copy_->field);
        }
        copy_->inertia = std::move(inertia);
        copy_->outflow = outflow;
    }
    kept_ = true;
}

void Undo::keep(const Snapshot& copy) {
    kept_ = false;  // until all memory is there
    copy_.reset();
    keep(copy.field, copy.inertia, copy.outflow);
    touch(copy_->field.bounds());  // the field may differ from `copy` everywhere
}

std::vector<CellRect> Undo::putBackHeights(HeightField& field) {
    std::vector<CellRect> tiles = takeTouched();
    for (const CellRect& tile : tiles) {
        copyCells(copy_->field, tile, field);
    }
    return tiles;
}

}  // namespace sand::grid
