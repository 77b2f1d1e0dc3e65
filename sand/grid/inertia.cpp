// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/inertia.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "base/field_forms.hpp"
#include "sand/grid/tile_grid.hpp"
#include "sand/model/grid_codec.hpp"
#include "sand/model/height_field.hpp"

namespace sand::grid {
namespace {

constexpr int kPiece = TileGrid::kTile;  // [cell], side of a piece after decode()

/// The numbers before the fluxes.
struct Head {
    std::int32_t undisturbed = 0;  // [sweep]
    bool flows = false;            // whether fluxes follow
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("undisturbed", base::limited(it.undisturbed, 0, Inertia::kMostCounted));
        visit("flows", it.flows);
    }
};

/// Returns the field's cells, and the column and row of fluxes over the western and southern rim.
CellRect withRim(int columns, int rows) { return {-1, -1, columns, rows}; }

std::shared_ptr<const PackedCells> copyOf(const CellArray& grid, const CellRect& cells) {
    PackedCells copy(grid, cells);
    return copy.isZero() ? nullptr : std::make_shared<const PackedCells>(std::move(copy));
}

/// Throws unless `flux` is 0, or `flows` and at most `most`. `way` and `cell` name the face.
void requirePossible(std::int32_t flux, bool flows, std::int32_t most, const char* way, const CellRect& cell) {
    if (flux == 0 || (flows && flux >= -most && flux <= most)) {
        return;
    }
    const std::string which = "sand with a flux of " + std::to_string(flux) + " to the " + way + " from column " +
                              std::to_string(cell.x0) + ", row " + std::to_string(cell.y0);
    throw base::FormatError(which + (flows ? ": the most is " + std::to_string(most)
                                           : ": no sand flows there, because the rim of this field is closed"));
}

/// Throws if a flux is one that no sweep makes.
void requirePossible(const CellArray& east, const CellArray& north, const FieldFaces& faces) {
    const CellRect all = withRim(faces.columns, faces.rows);
    const bool open = faces.rim == Rim::open;
    for (int y = all.y0; y < all.y1; ++y) {
        for (int x = all.x0; x < all.x1; ++x) {
            const CellRect cell{x, y, x + 1, y + 1};
            const bool insideEast = x >= 0 && x + 1 < faces.columns, insideNorth = y >= 0 && y + 1 < faces.rows;
            requirePossible(east.row(y)[x], y >= 0 && (open || insideEast), faces.mostFlux(), "east", cell);
            requirePossible(north.row(y)[x], x >= 0 && (open || insideNorth), faces.mostFlux(), "north", cell);
        }
    }
}

}  // namespace

void Inertia::keep(const CellArray& east, const CellArray& north, const CellRect& cells) {
    Piece piece{copyOf(east, cells), copyOf(north, cells)};
    if (piece.east != nullptr || piece.north != nullptr) {
        pieces_.push_back(std::move(piece));
    }
}

void Inertia::putInto(CellArray& east, CellArray& north) const {
    for (const Piece& piece : pieces_) {
        if (piece.east != nullptr) {
            piece.east->putInto(east);
        }
        if (piece.north != nullptr) {
            piece.north->putInto(north);
        }
    }
}

std::int64_t Inertia::bytes() const {
    auto bytes = static_cast<std::int64_t>(pieces_.capacity() * sizeof(Piece));
    for (const Piece& piece : pieces_) {
        bytes +=
            (piece.east != nullptr ? piece.east->bytes() : 0) + (piece.north != nullptr ? piece.north->bytes() : 0);
    }
    return bytes;
}

void Inertia::encode(std::shared_ptr<const PackedCells> Piece::*fluxes, int columns, int rows, base::ByteWriter& writer,
                     const std::function<void()>& between) const {
    CellArray window(columns, kPiece);  // rows [first, first + kPiece), and at first the row beyond the southern rim
    int first = -2 * kPiece;
    const auto rowOf = [&](int y) -> const std::int32_t* {
        if (const int wanted = std::max(y, 0) / kPiece * kPiece; wanted != first) {
            first = wanted;
            window = CellArray(columns, kPiece);
            const int from = first == 0 ? -1 : first;
            for (const Piece& piece : pieces_) {
                if (const PackedCells* const packed = (piece.*fluxes).get();
                    packed != nullptr && packed->cells().y0 < first + kPiece && packed->cells().y1 > from) {
                    const int begin = std::max(from, packed->cells().y0);
                    packed->putInto(window, begin, first + kPiece, begin - first);
                }
            }
        }
        return window.row(y - first);
    };
    encodeRows(withRim(columns, rows), rowOf, writer, between);
}

void Inertia::encode(int columns, int rows, base::ByteWriter& writer, const std::function<void()>& between) const {
    base::putMember(writer, Head{undisturbed_, !pieces_.empty()});
    if (!pieces_.empty()) {
        encode(&Piece::east, columns, rows, writer, between);
        encode(&Piece::north, columns, rows, writer, between);
    }
}

std::size_t Inertia::stripes(int columns, int rows) const {
    return pieces_.empty() ? 0 : 2 * stripesOf(withRim(columns, rows));
}

Inertia Inertia::decode(base::ByteReader& reader, const FieldFaces& faces,
                        const std::function<void(std::size_t)>& decoded) {
    const auto head = base::read<Head>(reader);
    Inertia inertia(head.undisturbed);
    if (head.flows) {
        CellArray east(faces.columns, faces.rows);
        CellArray north(faces.columns, faces.rows);
        const CellRect all = withRim(faces.columns, faces.rows);
        decodeCells(reader, all, kMaxHeight, east, decoded);
        decodeCells(reader, all, kMaxHeight, north, decoded);
        requirePossible(east, north, faces);
        for (int y = all.y0; y < all.y1; y += kPiece) {
            for (int x = all.x0; x < all.x1; x += kPiece) {
                inertia.keep(east, north, CellRect{x, y, x + kPiece, y + kPiece}.clippedTo(all));
            }
        }
    }
    return inertia;
}

}  // namespace sand::grid
