// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sand/grid/inertia.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/surface.hpp"

namespace sand::grid {

/// The sand of a height field.
class Snapshot final : public SurfaceCopy {
public:
    Snapshot(HeightField heights, Inertia fluxes, std::int64_t over)
        : field(std::move(heights)), inertia(std::move(fluxes)), outflow(over) {}

    [[nodiscard]] base::Bytes encode() const override;
    /// Of a field like this one. Throws base::FormatError when the bytes are none, or go on behind it.
    static Snapshot decode(std::span<const std::uint8_t> bytes, int columns, int rows, double cellSize);

    HeightField field;
    Inertia inertia;
    std::int64_t outflow = 0;  // [unit · cell]
};

/// The sand before a stroke, for an undo.
///
/// The first keep() copies the whole field; every later one only the tiles that were touched since the one before, and
/// an undo writes only those back. Costs four bytes a cell from the first stroke on, and nothing before.
class Undo {
public:
    /// These cells may now differ from what is kept.
    void touch(const CellRect& cells);
    void keep(const HeightField& field, Inertia inertia, std::int64_t outflow);
    void keep(const Snapshot& copy);
    /// Nothing is there to put back any more; what was copied still spares the next keep() most of its work.
    void forget() { kept_ = false; }

    /// The sand as it was kept last; null when there is none.
    [[nodiscard]] const Snapshot* kept() const { return kept_ ? &*copy_ : nullptr; }
    /// Writes the heights that may differ back into `field`, and returns where. Something must be kept.
    [[nodiscard]] std::vector<CellRect> putBackHeights(HeightField& field);

private:
    [[nodiscard]] std::vector<CellRect> takeTouched();

    std::optional<Snapshot> copy_;
    bool kept_ = false;
    int tilesAcross_ = 0;
    std::vector<std::uint8_t> touched_;  // by tile, since the copy was as the field is
};

}  // namespace sand::grid
