// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "sand/grid/inertia.hpp"
#include "sand/model/grid_codec.hpp"
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

/// The sand of a height field without its heights.
struct SandRest {
    Inertia inertia;
    std::int64_t outflow = 0;  // [unit · cell]
};

/// Writes sand whose heights are given row by row, as encodeRows() takes them. Calls `between` as encodeRows() does.
void encodeSand(const CellRect& field, const std::function<const std::int32_t*(int row)>& rowOf, const SandRest& rest,
                base::ByteWriter& writer, const std::function<void()>& between);
/// Reads what encodeSand() wrote for a field with these limits, and gives the heights to `take` row by row. Throws
/// base::FormatError for invalid bytes, for sand below rock, for fluxes that Inertia::decode() refuses, and if further
/// bytes follow. Volume and outflow together must be within ±kMaxHeight times the number of cells; steps keep that sum.
/// Calls `decoded` as decodeCells() does.
[[nodiscard]] SandRest decodeSand(std::span<const std::uint8_t> bytes, const SandLimits& limits,
                                  const RowsToDecode& take, const std::function<void(std::size_t)>& decoded = {});

/// Snapshot of the sand of a height field.
class Snapshot final : public SurfaceCopy {
public:
    Snapshot(HeightField heights, Inertia fluxes, std::int64_t over)
        : field(std::move(heights)), inertia(std::move(fluxes)), outflow(over) {}

    void encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const override;
    [[nodiscard]] std::size_t stripes() const override;
    /// Reads what encodeInto() wrote, as decodeSand() does.
    static Snapshot decode(std::span<const std::uint8_t> bytes, const SandLimits& limits,
                           const std::function<void(std::size_t)>& decoded = {});

    HeightField field;
    Inertia inertia;
    std::int64_t outflow = 0;  // [unit · cell]
};

}  // namespace sand::grid
