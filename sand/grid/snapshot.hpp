// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sand/grid/inertia.hpp"
#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/surface.hpp"

namespace sand::grid {

/// Limits of the sand of one field, which follow from its start.
struct SandLimits {
    FieldFaces faces;
    double cellSize = 1;             // [scene unit]
    const Ground* ground = nullptr;  // null without rock and wall cells
};

/// Snapshot of the sand of a height field.
class Snapshot final : public SurfaceCopy {
public:
    Snapshot(HeightField heights, Inertia fluxes, std::int64_t over)
        : field(std::move(heights)), inertia(std::move(fluxes)), outflow(over) {}

    [[nodiscard]] base::Bytes encode() const override;
    /// Reads what encode() wrote for a field with these limits. Throws base::FormatError for invalid bytes, for sand
    /// below rock, for fluxes that Inertia::decode() refuses, and if further bytes follow. Volume and outflow together
    /// must be within ±kMaxHeight times the number of cells; steps keep that sum.
    static Snapshot decode(std::span<const std::uint8_t> bytes, const SandLimits& limits);

    HeightField field;
    Inertia inertia;
    std::int64_t outflow = 0;  // [unit · cell]
};

/// Sand before a stroke, kept for an undo.
///
/// The first keep() copies the whole field. Each later one copies only the tiles that were touched since the last
/// keep(), and an undo writes back only those. It takes four bytes per cell from the first stroke on, and no memory
/// before.
class Undo {
public:
    /// Records that `cells` may now differ from the kept sand.
    void touch(const CellRect& cells);
    void keep(const HeightField& field, Inertia inertia, std::int64_t outflow);
    void keep(const Snapshot& copy);
    /// Drops the kept sand. The copy remains, so that the next keep() has little to copy.
    void forget() { kept_ = false; }

    /// Returns the sand that was kept last, or null if no sand is kept.
    [[nodiscard]] const Snapshot* kept() const { return kept_ ? &*copy_ : nullptr; }
    /// Writes the heights that may differ back into `field`, and returns their cells. Requires kept sand.
    [[nodiscard]] std::vector<CellRect> putBackHeights(HeightField& field);

private:
    [[nodiscard]] std::vector<CellRect> takeTouched();

    std::optional<Snapshot> copy_;
    bool kept_ = false;
    int tilesAcross_ = 0;
    std::vector<std::uint8_t> touched_;  // per tile: 1 if touched since the copy was equal to the field
};

}  // namespace sand::grid
