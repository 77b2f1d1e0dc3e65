// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/code_path.hpp"
#include "base/executor.hpp"
#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion_kernel.hpp"
#include "sand/grid/flux_limits.hpp"
#include "sand/model/ground.hpp"

namespace sand::grid {

/// Walks of sweeps over the active blocks of a field, and the memory that they use again and again.
///
/// A walk goes over the rows of blocks from south to north, and handles each cell row once. With an executor the rows
/// are divided into strips of whole rows of blocks, which are swept at the same time. The first and the last cell row
/// of a strip keep their old heights until all strips are swept. The strips beside it read them until then. So the
/// result does not depend on the division. Not thread-safe.
class ErosionWalk {
public:
    /// Limits of the fluxes on ground, and means of the sweep.
    struct Surroundings {
        const HeightField& field;        // the heights of the sweep
        const Ground* ground;            // null without rock and wall cells
        const Obstacle* obstacle;        // null without a tool. Without ground, Sweep::held limits the fluxes.
        const base::Executor* executor;  // null: the calling thread does all work
        base::CodePath path;
    };

    /// Sweeps the cells of `runs` once. Each is a run of blocks within one row of blocks; they are in the order of
    /// BlockMarks::takeRuns(), and do not touch within a row. Their ghost cells must be written. Returns the outflow
    /// over an open rim [unit · cell].
    std::int64_t sweep(const Sweep& sweep, const std::vector<CellRect>& runs, const Surroundings& surroundings);

    [[nodiscard]] std::size_t bytes() const;  // memory that is kept between sweeps

private:
    /// Row of blocks with active ones, in cells.
    struct Row {
        int y0, y1;
        std::size_t first, end;  // runs [first, end) of runs_
    };

    void findRows(const std::vector<CellRect>& runs);
    /// Divides the rows into strips of about the same number of cells.
    void divide(const Sweep& sweep, bool shared);
    /// Returns the buffers of a strip.
    [[nodiscard]] RowBuffers buffersOf(std::size_t strip);
    [[nodiscard]] std::span<const Run> runsOf(std::size_t row) const;
    /// Limits the fluxes of the runs of a row on ground. The limits must live as long as the row is swept.
    void limit(std::size_t row, const Surroundings& surroundings, std::vector<FluxLimits>& limits);
    /// Returns whether the row of blocks that begins where row `row` ends has active blocks, too.
    [[nodiscard]] bool continues(std::size_t row) const;
    /// Sweeps a strip, except for its first and last cell rows, which keep their heights. Returns its outflow.
    std::int64_t sweepStrip(const Sweep& sweep, std::size_t strip, const Surroundings& surroundings);
    /// Balances the first and the last cell row of a strip.
    void finishStrip(const Sweep& sweep, std::size_t strip, base::CodePath path);

    std::vector<Run> runs_;
    std::vector<Row> rows_;
    std::vector<std::size_t> strips_;     // first row of each strip, and the number of all rows
    std::vector<std::int64_t> outflows_;  // of each strip [unit · cell]
    std::vector<CellArray> buffers_;      // of each strip
};

}  // namespace sand::grid
