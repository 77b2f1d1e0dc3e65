// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/grid/packed_cells.hpp"
#include "sand/model/cell_array.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

/// The faces of a field, and what may flow through them.
struct FieldFaces {
    int columns = 0, rows = 0;  // of the field [cell]
    Rim rim = Rim::closed;
    std::int32_t aspect = kUnitsPerCell;  // Rules::aspect

    /// Returns the largest flux that a sweep can make [unit]. A flux is at most a share of the difference between two
    /// heights, which is at most 2 kMaxHeight. The share is below a quarter for square cells. For other cells, the
    /// shares along both axes add up to less than a half (sand/grid/erosion.cpp).
    [[nodiscard]] std::int32_t mostFlux() const { return aspect == kUnitsPerCell ? kMaxHeight / 2 : kMaxHeight; }
};

/// Everything except heights that the next sweeps depend on: the fluxes of the last sweep, and the age of the inertia.
/// The fluxes also show in which cells sand slid. Only areas in which sand flowed are held, so that sand at rest takes
/// no memory. Copies share the fluxes.
class Inertia {
public:
    static constexpr int kMostCounted = 1000;  // [sweep]; the momentum reaches its maximum long before

    Inertia() = default;
    explicit Inertia(int undisturbed) : undisturbed_(undisturbed) {}

    /// Copies the fluxes of `cells`, unless all of them are 0. Pass each cell only once, and rectangles of few cells,
    /// because the fluxes of a rectangle are packed and unpacked together.
    void keep(const CellArray& east, const CellArray& north, const CellRect& cells);
    /// Writes the kept fluxes into `east` and `north`, whose fluxes must be 0.
    void putInto(CellArray& east, CellArray& north) const;
    /// Returns the memory of the kept fluxes, which copies share [byte].
    [[nodiscard]] std::int64_t bytes() const { return bytes_; }
    [[nodiscard]] int undisturbed() const { return undisturbed_; }  // age of the inertia [sweep]
    /// Calls visit(cells) for each area whose fluxes are kept. It may begin at column or row -1.
    template <class Visit>
    void visitAreas(const Visit& visit) const {
        for (const Piece& piece : pieces_) {
            visit((piece.east != nullptr ? piece.east : piece.north)->cells());
        }
    }

    /// Writes the fluxes as two whole grids of a field of this size. The division into pieces makes no difference.
    /// Needs memory for a few rows of them. Calls `between` as encodeCells() does.
    void encode(int columns, int rows, base::ByteWriter& writer, const std::function<void()>& between = {}) const;
    /// Returns how often encode() calls `between`.
    [[nodiscard]] std::size_t stripes(int columns, int rows) const;
    /// Reads what encode() wrote. Throws base::FormatError for invalid bytes, and for a flux that no sweep of these
    /// faces makes. A sweep takes the fluxes of closed rims from memory, where they are 0, and never computes them.
    /// Another number would change the volume in each sweep. Calls `decoded` as decodeCells() does.
    static Inertia decode(base::ByteReader& reader, const FieldFaces& faces,
                          const std::function<void(std::size_t)>& decoded = {});

private:
    struct Piece {
        std::shared_ptr<const PackedCells> east, north;  // null if all of these fluxes are 0
    };
    void encode(std::shared_ptr<const PackedCells> Piece::*fluxes, int columns, int rows, base::ByteWriter& writer,
                const std::function<void()>& between) const;
    int undisturbed_ = 0;
    std::vector<Piece> pieces_;
    std::int64_t bytes_ = 0;  // of the pieces, which never change
};

}  // namespace sand::grid
