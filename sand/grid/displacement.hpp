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
    /// Far above every height: less a height, it is more than any two heights differ [unit].
    static constexpr std::int32_t kFree = 1 << 30;
    // A sweep reads beside the tool without a check, and by whole vectors.
    static constexpr int kRowsBeside = 2, kColumnsBeside = 16;  // [cell], on each side

    /// Columns [x0, x1).
    struct Columns {
        int x0, x1;
        friend bool operator==(const Columns&, const Columns&) = default;
    };

    CellRect cells;  // cells of the field that may be below the tool
    /// At most kMaxHeight [unit], row by row over `cells` and the cells beside them; kFree beside the tool.
    std::vector<std::int32_t> underside;
    /// The cells below the tool and those one beside them, by row from cells.y0 - 1 to cells.y1, both included.
    std::vector<Columns> reached;

    [[nodiscard]] std::ptrdiff_t stride() const { return cells.x1 - cells.x0 + std::ptrdiff_t{2} * kColumnsBeside; }
    /// Returns the undersides of a row, which is in `cells` or at most kRowsBeside from them. They begin at column
    /// cells.x0.
    [[nodiscard]] const std::int32_t* row(int row) const {
        return underside.data() + (row - cells.y0 + kRowsBeside) * stride() + kColumnsBeside;
    }
    /// Fills `reached` from `underside`.
    void findReached();
};

/// Moves a tool through the sand of a grid (Dorjgotov et al. 2007, section 3). Takes out the sand above the tool's
/// underside and puts it down ahead.
class Displacement {
public:
    /// The results are the same with every `path`.
    explicit Displacement(const Tool& tool, base::CodePath path = base::fastestCodePath())
        : tool_(tool), shape_(tool, TurnedShape::SphereRing::wide, path), path_(path) {}

    /// Effect of one drag on the sand.
    struct Work {
        CellRect cells{};                                    // cells that may have changed
        std::int64_t outflow = 0;                            // volume pushed over an open rim [unit · cell]
        std::int64_t refused = 0;                            // presses whose sand did not fit
        std::int64_t searches = 0;                           // of them, for which a height was searched
        std::optional<std::int32_t> largest = std::nullopt;  // RefusedPress::largest of the first of them

        void add(const Work& other) {
            cells = cells.joinedWith(other.cells);
            outflow += other.outflow;
            refused += other.refused;
            searches += other.searches;
        }
    };

    /// A search for the height at which the sand of a press fits tries at most so many heights.
    static constexpr std::int64_t kMostTrials = 25;

    /// Moves the tool from `from` to `to` in sub-steps of substepOnGrid(), and displaces the sand. If no cell can take
    /// the sand of a press, the tool digs less deep there. After `mostSearches` of such presses it passes through the
    /// sand instead. `ground` may be null; its rock and walls do not move. Sand stays on its side of walls, and of rock
    /// that is higher than the sand that the tool takes. If `measures`, returns Work::largest.
    Work drag(HeightField& field, Rim rim, const Ground* ground, ProbePoint from, ProbePoint to, bool measures = false,
              std::int64_t mostSearches = INT64_MAX) const;

    /// Returns a rectangle that contains all cells of the field that drag() may change. It may contain further cells.
    [[nodiscard]] CellRect cellsChanged(const HeightField& field, ProbePoint from, ProbePoint to) const {
        const auto around = [this](const ProbePoint& at) { return shape_.cellsChanged(at.x, at.y); };
        return around(from).joinedWith(around(to)).clippedTo(field.bounds());
    }
    /// Returns the distance from the tool's centre up to which a coarse phase slides sand [cell].
    [[nodiscard]] int reachOfCoarsePhase() const {
        return SweepPlan::reach(tool_.radius / kProbePerCell) + shape_.ringCells();
    }
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
    /// Presses with the tool above `at`, at a height at which its sand fits, in whole probe units. One probe unit below
    /// it does not fit.
    Work pressAbove(HeightField& field, Rim rim, const Ground* ground, Press at) const;
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
