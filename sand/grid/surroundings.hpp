// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/step.hpp"
#include "sand/model/tool_shape.hpp"

namespace sand::grid {

/// Returns the offset of a cell's centre from the tool's centre at `probe`.
inline Offset offsetOf(ProbePoint probe, int column, int row) {
    constexpr std::int32_t kHalfCell = kProbePerCell / 2;
    return {std::int64_t{column} * kProbePerCell + kHalfCell - probe.x,
            std::int64_t{row} * kProbePerCell + kHalfCell - probe.y};
}

/// Sand that a tool cuts off in one sub-step.
struct Cut {
    CellRect cells;                    // cells of the field that may be below the tool
    std::vector<int> rows;             // rows in which the tool cuts sand, ascending
    std::vector<std::int32_t> lowest;  // [unit], for each of `rows` over all columns of `cells`: what the tool leaves
    std::int64_t taken = 0;            // [unit · cell]

    [[nodiscard]] std::size_t across() const { return static_cast<std::size_t>(cells.x1 - cells.x0); }
    [[nodiscard]] const std::int32_t* lowestOf(std::size_t row /* index of `rows` */) const {
        return lowest.data() + row * across();
    }
};

/// The cells that a tool covers or that may take its sand, divided into parts. Sand never leaves its part.
///
/// Cells are joined over faces. Walls divide them. A cell also leaves its part if its rock is higher than the highest
/// cell from which the tool takes sand in this part. If such cells cut a part in two, each piece becomes a part, for
/// which the same holds.
class Surroundings {
public:
    static constexpr std::int32_t kNone = -1;  // part of a cell to which no sand may go

    Surroundings(const HeightField& field, const Ground& ground, const TurnedShape& shape, ProbePoint probe,
                 const Cut& cut);

    /// Returns whether a wall, or rock higher than all sand of the cut, is among the cells. Otherwise the tool works as
    /// without ground, and parts must not be asked for.
    [[nodiscard]] bool barred() const { return barred_; }
    /// Returns the number of parts. They are numbered from 0.
    [[nodiscard]] std::int32_t count() const { return static_cast<std::int32_t>(taken_.size()); }
    /// Returns the sand that the tool takes from a part [unit · cell].
    [[nodiscard]] std::int64_t taken(std::int32_t part) const { return taken_[static_cast<std::size_t>(part)]; }
    /// Returns the part of a cell, or kNone. A place beyond the field belongs to the part of the nearest cell that has
    /// one. If several are as near, the first by rows counts.
    [[nodiscard]] std::int32_t partOf(int column, int row) const;

private:
    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row - box_.y0) * static_cast<std::size_t>(box_.x1 - box_.x0) +
               static_cast<std::size_t>(column - box_.x0);
    }
    void findCells(const HeightField& field, const Ground& ground, const TurnedShape& shape, ProbePoint probe,
                   const Cut& cut);
    /// Moves the cells that are joined to cell `first` from kWaiting to `part`. Returns them.
    std::vector<std::size_t> join(std::size_t first, std::int32_t part);
    void divide(const Ground& ground);
    [[nodiscard]] std::int32_t nearestPart(int column, int row, int x, int y) const;

    static constexpr std::int32_t kWaiting = -2;  // part of a cell that is not in a part yet

    CellRect box_;                       // within the field
    std::vector<std::int32_t> parts_;    // by cell of the box
    std::vector<std::int32_t> heights_;  // [unit], by cell of the box, of the cells from which sand is taken
    std::vector<std::int32_t> over_;     // [unit], by cell of the box: the sand that is taken
    std::vector<std::int64_t> taken_;    // by part
    bool barred_ = false;
};

}  // namespace sand::grid
