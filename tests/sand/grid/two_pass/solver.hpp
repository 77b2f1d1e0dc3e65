// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/grid/displacement.hpp"
#include "sand/model/ground.hpp"
#include "sand/model/rules.hpp"

namespace two_pass {

/// Sweeps a whole field in two passes, and skips no block at rest. A change of `field`, `rules` or `tool` takes effect
/// in the next sweep; the caller then sets `undisturbed` to 0.
class Solver {
public:
    sand::HeightField field;
    sand::Rules rules;
    const sand::grid::Obstacle* tool = nullptr;  // null: no tool is in the sand
    int undisturbed = 0;                         // [sweep], sweeps that moved sand since something else changed it
    std::int64_t outflow = 0;                    // volume lost over an open rim [unit · cell]

    Solver(const sand::HeightField& start, const sand::Rules& laws, const sand::Ground* rock)
        : field(start),
          rules(laws),
          ground_(rock),
          east_(start.columns(), start.rows()),
          north_(east_),
          sliding_(east_) {}

    /// Runs `sweeps` sweeps, and stops earlier if all sand is at rest.
    void sweep(int sweeps);

private:
    /// Calls task(cells) for each patch.
    template <class Task>
    void forEachPatch(const Task& task) const;
    void sweepFluxes(const sand::CellRect& cells, float momentum);
    [[nodiscard]] bool balance(const sand::CellRect& cells);

    const sand::Ground* ground_;
    sand::CellArray east_, north_, sliding_;
};

}  // namespace two_pass
