// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "sand/model/step.hpp"
#include "sand/model/tool_shape.hpp"

namespace sand::grid {

/// The underside of the tool while it stands in the sand: no flux may raise a cell above it.
struct Obstacle {
    CellRect cells;                       // where the underside is defined
    std::vector<std::int32_t> underside;  // [unit], row by row over `cells`; kFree beside the tool
    static constexpr std::int32_t kFree = TurnedShape::kFree;

    [[nodiscard]] const std::int32_t* row(int row) const {  // from cells.x0 on
        return underside.data() + std::ptrdiff_t{row - cells.y0} * (cells.x1 - cells.x0);
    }
};

/// Moves a tool through the sand of a grid (Dorjgotov et al. 2007, section 3). Takes out the sand above the tool's
/// underside and puts it down ahead.
class Displacement {
public:
    /// `v3`: with instructions of x86-64-v3, for the same results.
    explicit Displacement(const ToolShape& shape, const Heading& heading = {}, bool v3 = base::machineHasV3())
        : shape_(shape, heading, v3), v3_(v3) {}

    /// What one drag did to the sand.
    struct Work {
        CellRect cells;            // may have changed
        std::int64_t outflow = 0;  // [unit · cell] pushed over an open rim
    };

    /// Sweeps the tool from `from` to `to` in sub-steps of at most a cell. Where no cell could take the sand, it stays.
    /// Rock and walls of `ground`, which may be null, stay where they are.
    Work drag(HeightField& field, Rim rim, const Ground* ground, ProbePoint from, ProbePoint to) const;

    /// The tool at rest at `at`, as seen by flowing sand.
    [[nodiscard]] Obstacle obstacle(const HeightField& field, ProbePoint at) const;
    /// The cells that its underside may cover there.
    [[nodiscard]] CellRect cells(const HeightField& field, ProbePoint at) const;

private:
    Work press(HeightField& field, Rim rim, const Ground* ground, ProbePoint at, const Offset& ahead) const;
    /// How low the tool takes the cells of a row, whatever lies there: its underside, or the rock beneath.
    void findLowest(const Ground* ground, ProbePoint at, int column, int row, std::span<std::int32_t> lowest) const;

    TurnedShape shape_;
    bool v3_;
};

}  // namespace sand::grid
