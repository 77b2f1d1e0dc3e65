// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/height_field.hpp"
#include "sand/scene.hpp"
#include "sand/step.hpp"
#include "sand/tool_shape.hpp"

namespace sand {

/// The underside of the tool while it stands in the sand: no flux may raise a cell above it.
struct Obstacle {
    Rect cells;                           // where the underside is defined
    std::vector<std::int32_t> underside;  // [unit], row by row over `cells`; kFree beside the tool
    static constexpr std::int32_t kFree = TurnedShape::kFree;

    [[nodiscard]] std::int32_t at(int column, int row) const {
        return underside[static_cast<std::size_t>((row - cells.y0) * (cells.x1 - cells.x0) + column - cells.x0)];
    }
};

/// A tool in the sand: it takes out what lies above its underside and puts it down ahead (first paper, section 3).
class Tool {
public:
    explicit Tool(const ToolShape& shape, const Heading& heading = {}) : shape_(shape, heading) {}

    /// What one drag did to the sand.
    struct Displacement {
        Rect cells;                // may have changed
        std::int64_t outflow = 0;  // [unit · cell] pushed over an open rim
    };

    /// Sweeps the tool from `from` to `to` in sub-steps of at most a cell. Where no cell could take the sand, it stays.
    /// Rock and walls of `ground`, which may be null, stay where they are.
    Displacement drag(HeightField& field, Rim rim, const Ground* ground, ProbePoint from, ProbePoint to) const;

    /// The tool at rest at `at`, as seen by flowing sand.
    [[nodiscard]] Obstacle obstacle(const HeightField& field, ProbePoint at) const;
    /// The cells that its underside may cover there.
    [[nodiscard]] Rect cells(const HeightField& field, ProbePoint at) const;

private:
    Displacement press(HeightField& field, Rim rim, const Ground* ground, ProbePoint at, const Offset& ahead) const;
    /// The height to which the tool takes a cell down: its underside, or the rock beneath.
    [[nodiscard]] std::int32_t cutTo(const HeightField& field, const Ground* ground, ProbePoint at, int column,
                                     int row) const;

    TurnedShape shape_;
};

}  // namespace sand
