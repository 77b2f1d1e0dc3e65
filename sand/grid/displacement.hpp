// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "sand/model/step.hpp"
#include "sand/model/tool_shape.hpp"

namespace sand::grid {

struct Cut;
class Surroundings;

/// Underside of the tool while it is in the sand. No flux may raise a cell above it.
struct Obstacle {
    CellRect cells;                       // cells for which the underside is defined
    std::vector<std::int32_t> underside;  // [unit], row by row over `cells`; kFree beside the tool
    static constexpr std::int32_t kFree = TurnedShape::kFree;

    [[nodiscard]] const std::int32_t* row(int row) const {  // begins at column cells.x0
        return underside.data() + std::ptrdiff_t{row - cells.y0} * (cells.x1 - cells.x0);
    }
};

/// Moves a tool through the sand of a grid (Dorjgotov et al. 2007, section 3). Takes out the sand above the tool's
/// underside and puts it down ahead.
class Displacement {
public:
    /// The results are the same with every `path`.
    explicit Displacement(const Tool& tool, base::CodePath path = base::fastestCodePath())
        : tool_(tool), shape_(tool, path), path_(path) {}

    /// Effect of one drag on the sand.
    struct Work {
        CellRect cells{};                                    // cells that may have changed
        std::int64_t outflow = 0;                            // volume pushed over an open rim [unit · cell]
        std::int64_t refused = 0;                            // presses with sand that stayed where it was
        std::optional<std::int32_t> largest = std::nullopt;  // RefusedPress::largest of the first of them
    };

    /// Moves the tool from `from` to `to` in sub-steps of at most one cell, and displaces the sand. Sand that no cell
    /// can take stays where it is. `ground` may be null; its rock and walls do not move. Sand stays on its side of
    /// walls, and of rock that is higher than the sand that the tool takes. If `measures`, returns Work::largest.
    Work drag(HeightField& field, Rim rim, const Ground* ground, ProbePoint from, ProbePoint to,
              bool measures = false) const;

    /// Returns the obstacle of a tool whose centre is at `probe`.
    [[nodiscard]] Obstacle obstacle(const HeightField& field, ProbePoint probe) const;
    /// Returns the cells of the field that may be below the tool while its centre is at `probe`.
    [[nodiscard]] CellRect cells(const HeightField& field, ProbePoint probe) const;

private:
    /// Place of a press, and the direction in which the sand goes; {0, 0} for all sides.
    struct Press {
        ProbePoint probe;
        Offset ahead;
    };
    /// Presses the sand of `field`. Changes `into`, which is `field`, or null to find out what would be refused.
    Work press(const HeightField& field, HeightField* into, Rim rim, const Ground* ground, const Press& at) const;
    /// Does the work of press() part by part of the surroundings, which must be barred.
    Work pressInParts(const HeightField& field, HeightField* into, Rim rim, const Ground& ground, const Press& at,
                      const Cut& cut, const Surroundings& surroundings) const;
    /// Returns RefusedPress::largest of a press that was refused.
    [[nodiscard]] std::int32_t largestRadius(const HeightField& field, Rim rim, const Ground* ground,
                                             const Press& at) const;
    [[nodiscard]] Cut findCut(const HeightField& field, const Ground* ground, ProbePoint probe) const;
    /// Fills `lowest` with the heights to which the tool lowers the cells of a row: its underside, or the rock where
    /// that is higher [unit]. `column` is the first cell of the row.
    void findLowest(const Ground* ground, ProbePoint probe, int column, int row, std::span<std::int32_t> lowest) const;

    Tool tool_;
    TurnedShape shape_;
    base::CodePath path_;
};

}  // namespace sand::grid
