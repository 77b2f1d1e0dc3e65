// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/model/cell_array.hpp"

namespace sand::grid {

/// What the next sweeps depend on beside the heights: the fluxes of the last one, which also say in which cells sand
/// slid, and for how long sand has slid undisturbed. Holds the cells in which sand flowed and no others: of sand at
/// rest nothing.
class Inertia {
public:
    static constexpr int kMostCounted = 1000;  // [sweep]; the momentum is at its most long before

    Inertia() = default;
    explicit Inertia(int undisturbed) : undisturbed_(undisturbed) {}

    /// Copies the fluxes of these cells, unless all of them are zero. Cells are to be given once.
    void keep(const CellArray& east, const CellArray& north, const CellRect& cells);
    /// Writes what was kept into fluxes that are zero.
    void putInto(CellArray& east, CellArray& north) const;
    [[nodiscard]] int undisturbed() const { return undisturbed_; }  // [sweep]

    /// As two whole grids of a field of this size, whatever the pieces were.
    void encode(int columns, int rows, base::ByteWriter& writer) const;
    /// Throws base::FormatError.
    static Inertia decode(base::ByteReader& reader, int columns, int rows);

private:
    struct Piece {
        CellRect cells;
        std::vector<std::int32_t> east, north;  // row by row
    };
    int undisturbed_ = 0;
    std::vector<Piece> pieces_;
};

}  // namespace sand::grid
