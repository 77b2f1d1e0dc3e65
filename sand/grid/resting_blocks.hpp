// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/cell_array.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

/// Finds blocks through whose faces no sand can flow in the next sweep, from the heights alone. Their fluxes must be 0.
///
/// The test is cautious. In the block and one cell around it, no two neighbouring heights may differ by more than the
/// threshold divided by √2. The slope across a face and the mean slope along it then stay below the threshold together.
/// A block that fails the test may be at rest, too. The heights are read once, and no flux is read or written.
/// Threads: not thread-safe.
class RestingBlocks {
public:
    /// `blockSize` is the side of a block [cell]. `storage` is memory for the search, which the next object may use
    /// again. Its content does not matter.
    RestingBlocks(const HeightField& field, const Rules& rules, int blockSize, std::vector<std::uint32_t>& storage);

    /// Appends the parts of a run that are not certainly at rest. `run` is a run of blocks within one row [block]; so
    /// are the parts, which do not touch each other. Blocks at an open rim are never at rest. The field has no rock and
    /// no walls.
    void appendOthers(const CellRect& run, std::vector<CellRect>& others);

private:
    /// Marks the cells of `cells` that differ too much from the next cell in the east or in the north.
    void markSteep(const CellRect& cells);

    const HeightField& field_;
    int blockSize_;
    bool openRim_;
    std::int32_t mostEast_, mostNorth_;  // allowed differences [unit]
    std::vector<std::uint32_t>& steep_;  // of each column: not 0 if a cell of the current row of blocks is steep
};

}  // namespace sand::grid
