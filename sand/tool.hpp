// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "sand/height_field.hpp"
#include "sand/scene.hpp"
#include "sand/step.hpp"

namespace sand {

/// The underside of the tool while it stands in the sand: no flux may raise a cell above it.
struct Obstacle {
    Rect cells;                           // where the underside is defined
    std::vector<std::int32_t> underside;  // [unit], row by row over `cells`; kFree beside the tool
    static constexpr std::int32_t kFree = std::numeric_limits<std::int32_t>::max();

    [[nodiscard]] std::int32_t at(int column, int row) const {
        return underside[static_cast<std::size_t>((row - cells.y0) * (cells.x1 - cells.x0) + column - cells.x0)];
    }
};

/// The paper's sphere: it takes out what lies above its underside and puts it down ahead (first paper, section 3).
///
/// All arithmetic is on integers and on IEEE square roots of exact integers: the same on every machine.
class SphereTool {
public:
    explicit SphereTool(std::int32_t radius /* [probe unit] */) : radius_(radius) {}

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

private:
    Displacement press(HeightField& field, Rim rim, const Ground* ground, ProbePoint at, std::int64_t dx,
                       std::int64_t dy) const;
    /// The height to which the tool takes a cell down: its underside, or the rock beneath.
    [[nodiscard]] std::int32_t cutTo(const HeightField& field, const Ground* ground, ProbePoint at, int column,
                                     int row) const;
    [[nodiscard]] Rect footprint(ProbePoint at, int margin) const;
    /// Height of the sphere's underside over the centre of a cell [unit], or Obstacle::kFree beside it.
    [[nodiscard]] std::int32_t underside(ProbePoint at, int column, int row) const;

    std::int32_t radius_;
};

}  // namespace sand
