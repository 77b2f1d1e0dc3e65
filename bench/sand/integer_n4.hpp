// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/code_path.hpp"
#include "sand/grid/net_flux.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace bench {

/// The arrays of one sweep. All three have the same stride and a margin of one cell on every side.
struct IntegerN4Sweep {
    std::int32_t* heights;  // [unit], at cell (0,0)
    std::int32_t* east;     // flux from each cell to its eastern neighbour [unit]; written
    std::int32_t* north;    // flux from each cell to its northern neighbour [unit]; written
    std::ptrdiff_t stride;  // [cell]
    int columns, rows;
    std::int32_t threshold, startThreshold;  // [unit]
};

// integer_n4.cpp is compiled twice, like baseline_schemes.cpp. sweep() returns whether any sand moved.
namespace baseline {
bool sweep(const IntegerN4Sweep& patch);
}
namespace v3 {
bool sweep(const IntegerN4Sweep& patch);
}

/// The four-neighbour rule in integers, for comparison only: it rests in the wrong pile at every resolution.
///
/// The flux across a face depends on its two cells only. If their difference is above the start threshold, a quarter of
/// the excess over the threshold flows, rounded up. All fluxes come from the heights before the sweep, so the volume is
/// exact. The box is closed and its cells are square. With a threshold below 4 units, rounding up keeps the sand
/// moving.
class IntegerN4 {
public:
    /// Takes the heights of `start`. The heights are the same with every `path`.
    IntegerN4(const sand::HeightField& start, const sand::Rules& rules, base::CodePath path = base::fastestCodePath())
        : field_(start),
          east_(start.columns(), start.rows()),
          north_(start.columns(), start.rows()),
          patch_{.heights = field_.row(0),
                 .east = east_.row(0),
                 .north = north_.row(0),
                 .stride = field_.stride(),
                 .columns = start.columns(),
                 .rows = start.rows(),
                 .threshold = rules.tuning.threshold,
                 .startThreshold = rules.tuning.startThreshold},
          path_(path) {}
    IntegerN4(const IntegerN4&) = delete;
    IntegerN4& operator=(const IntegerN4&) = delete;

    /// Runs at most `count` sweeps. Stops after the first sweep in which no sand moves, which counts too.
    void sweep(int count) {
        for (int i = 0; i < count && !atRest_; ++i) {
            atRest_ = !(path_ != base::CodePath::baseline ? v3::sweep(patch_) : baseline::sweep(patch_));
            ++sweepsDone_;
        }
    }
    /// Adds the fluxes of the last sweep to `sum`.
    void addFluxes(sand::grid::NetFlux& sum) const {
        for (int y = 0; y < field_.rows(); ++y) {
            for (int x = 0; x < field_.columns(); ++x) {
                sum.east(y)[x] += east_.row(y)[x];
                sum.north(y)[x] += north_.row(y)[x];
            }
        }
    }
    [[nodiscard]] bool atRest() const { return atRest_; }
    [[nodiscard]] std::int64_t sweepsDone() const { return sweepsDone_; }
    [[nodiscard]] const sand::HeightField& field() const { return field_; }

private:
    sand::HeightField field_;
    sand::CellArray east_, north_;
    IntegerN4Sweep patch_;
    base::CodePath path_;
    bool atRest_ = false;
    std::int64_t sweepsDone_ = 0;
};

}  // namespace bench
