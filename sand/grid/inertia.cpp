// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/inertia.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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

enum class Way : std::uint8_t { east, north };

/// Throws because of a flux that no sweep makes. `flows` says whether sand flows there at all.
[[noreturn]] void refuse(std::int32_t flux, bool flows, std::int32_t most, const char* way, int x, int y) {
    const std::string which = "sand with a flux of " + std::to_string(flux) + " to the " + way + " from column " +
                              std::to_string(x) + ", row " + std::to_string(y);
    throw base::FormatError(which + (flows ? ": the most is " + std::to_string(most)
                                           : ": no sand flows there, because the rim of this field is closed"));
}

/// Throws if a flux of row `y` is one that no sweep makes. `row` begins at column -1.
void requirePossible(const std::vector<std::int32_t>& row, int y, Way way, const FieldFaces& faces) {
    const bool open = faces.rim == Rim::open;
    for (int x = -1; x < faces.columns; ++x) {
        const std::int32_t flux = row[static_cast<std::size_t>(x + 1)];
        if (flux == 0) {
            continue;
        }
        const bool flows = way == Way::east ? y >= 0 && (open || (x >= 0 && x + 1 < faces.columns))
                                            : x >= 0 && (open || (y >= 0 && y + 1 < faces.rows));
        if (!flows || flux < -faces.mostFlux() || flux > faces.mostFlux()) {
            refuse(flux, flows, faces.mostFlux(), way == Way::east ? "east" : "north", x, y);
        }
    }
}

/// The pieces of a field with its rim, row by row from the south-west, and which of them have fluxes.
class Pieces {
public:
    explicit Pieces(const CellRect& all)
        : all_(all),
          across_((all.x1 - all.x0 + kPiece - 1) / kPiece),
          flows_(static_cast<std::size_t>(across_ * ((all.y1 - all.y0 + kPiece - 1) / kPiece))) {}

    /// Copies the parts of a row that have fluxes into `fluxes`. The pages of the others are not touched.
    void take(const std::vector<std::int32_t>& row, int y, CellArray& fluxes) {
        const std::size_t first = static_cast<std::size_t>((y - all_.y0) / kPiece * across_);
        for (int i = 0; i < across_; ++i) {
            const int from = i * kPiece, end = std::min(from + kPiece, all_.x1 - all_.x0);
            if (std::any_of(row.begin() + from, row.begin() + end, [](std::int32_t flux) { return flux != 0; })) {
                std::copy(row.begin() + from, row.begin() + end, fluxes.row(y) + all_.x0 + from);
                flows_[first + static_cast<std::size_t>(i)] = true;
            }
        }
    }
    template <class Visit>
    void visitFlowing(const Visit& visit) const {
        for (std::size_t i = 0; i < flows_.size(); ++i) {
            if (flows_[i]) {
                const int x = all_.x0 + static_cast<int>(i) % across_ * kPiece;
                const int y = all_.y0 + static_cast<int>(i) / across_ * kPiece;
                visit(CellRect{x, y, x + kPiece, y + kPiece}.clippedTo(all_));
            }
        }
    }

private:
    CellRect all_;
    int across_;
    std::vector<bool> flows_;
};

}  // namespace

void Inertia::keep(const CellArray& east, const CellArray& north, const CellRect& cells) {
    Piece piece{copyOf(east, cells), copyOf(north, cells)};
    if (piece.east != nullptr || piece.north != nullptr) {
        for (const auto& fluxes : {piece.east, piece.north}) {
            bytes_ += fluxes == nullptr ? 0 : fluxes->bytes();
        }
        bytes_ += static_cast<std::int64_t>(sizeof piece);
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
        const CellRect all = withRim(faces.columns, faces.rows);
        CellArray east(faces.columns, faces.rows), north(faces.columns, faces.rows);
        std::vector<std::int32_t> row(static_cast<std::size_t>(all.x1 - all.x0));
        Pieces pieces(all);
        for (const Way way : {Way::east, Way::north}) {
            const auto done = [&](int y) {
                requirePossible(row, y, way, faces);
                pieces.take(row, y, way == Way::east ? east : north);
            };
            decodeRows(reader, all, kMaxHeight, {[&](int) { return row.data(); }, done}, decoded);
        }
        pieces.visitFlowing([&](const CellRect& cells) { inertia.keep(east, north, cells); });
    }
    return inertia;
}

}  // namespace sand::grid
