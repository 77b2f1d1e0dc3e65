// SPDX-License-Identifier: Apache-2.0
#include "sand/model/sweep_plan.hpp"

#include <algorithm>

namespace sand {
namespace {

constexpr std::int32_t kFineSweeps = 8;  // after a coarse phase
constexpr std::int32_t kFirstSide = 4;   // [cell], of the coarsest level of a tool that needs no coarser one
// A tool that is not round piles up sand in its corners and in narrow strips beside it.
constexpr std::int32_t kFinestSideBesideCorners = 2;  // [cell]
constexpr std::int32_t kMostCoarseSweeps = 64;  // of the coarsest level, if a coarser one would still resolve the tool
// Sand would flow through a tool that is narrower than a few coarse cells.
constexpr std::int32_t kNarrowest = 8;          // [cell], half width of a tool with a coarse phase
constexpr std::int32_t kAcross = 6;             // cells of a level across half of the width, if its side was doubled
constexpr std::int32_t kLeastCoarseSweeps = 4;  // of the coarsest level

/// Returns the sweeps of a level with cells of `side` cells that carry sand as far as `all` sweeps of the field.
std::int32_t sweepsAt(std::int32_t side, std::int32_t all) { return (all + side * side - 1) / (side * side); }

SweepPlan withoutCoarsePhase(const Tuning& tuning) {
    const std::int32_t sweeps = std::min(tuning.sweepsPerStep, kMostSweeps);
    return {sweeps, sweeps, 0, 0, 0};
}

}  // namespace

SweepPlan gridSweepPlan(const Tuning& tuning) {
    const std::int32_t all = tuning.sweepsPerStep, cells = tuning.tool.radius / kProbePerCell;
    const std::int32_t still = std::clamp(cells, kFineSweeps, std::int32_t{64});
    const std::int32_t halfWidth = isRound(tuning.tool.kind) ? cells : tuning.tool.halfWidth / kProbePerCell;
    if (tuning.tool.radius <= kLargestPlainTool || halfWidth < kNarrowest || all <= still) {
        return withoutCoarsePhase(tuning);
    }
    std::int32_t side = kFirstSide;
    while (sweepsAt(side, all) > kMostCoarseSweeps && 2 * side * kAcross <= halfWidth) {
        side *= 2;
    }
    const std::int32_t finest = isRound(tuning.tool.kind) ? kFirstSide : kFinestSideBesideCorners;
    return {kFineSweeps, still, side, finest, std::clamp(sweepsAt(side, all), kLeastCoarseSweeps, kMostSweeps)};
}

SweepPlan tinSweepPlan(const Tuning& tuning) { return withoutCoarsePhase(tuning); }

}  // namespace sand
