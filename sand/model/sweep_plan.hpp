// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/model/tuning.hpp"

namespace sand {

/// Numbers of sweeps in a step, on the field and on coarser cells. All replicas compute them from the same integers.
///
/// Sand beside a tool of R cells needs about R² sweeps to come to rest. A large tool of a height field therefore has a
/// coarse phase. It comes before the sweeps of a step that moves the tool. Its sweeps on larger cells carry the sand
/// over long distances. docs/sand.md#large-tools has the law.
struct SweepPlan {
    static constexpr std::int32_t kFinerSweeps = 16;  // of each level but the coarsest

    std::int32_t moved = 0;  // sweeps that a step owes which moves the tool
    std::int32_t still = 0;  // sweeps that any other step owes
    /// Side of the cells of the coarsest and of the finest coarse level [cell], powers of two; 0 without a coarse
    /// phase. Each level has half the side of the one before.
    std::int32_t coarsest = 0, finest = 0;
    std::int32_t coarsestSweeps = 0;

    /// Returns the distance beyond the ring up to which a coarse phase slides sand, of a tool of `radius` [cell]. With
    /// half a radius less, several times as much sand of a stroke is in another place (`sandwall-bench large-tools`).
    [[nodiscard]] static constexpr std::int32_t reach(std::int32_t radius) { return radius * 7 / 4; }
    [[nodiscard]] bool hasCoarsePhase() const { return coarsest > 0; }
    /// Returns the sweeps of the level with this side.
    [[nodiscard]] std::int32_t sweepsOf(std::int32_t side) const {
        return side == coarsest ? coarsestSweeps : kFinerSweeps;
    }
    friend bool operator==(const SweepPlan&, const SweepPlan&) = default;
};

/// Returns the plan of a height field.
[[nodiscard]] SweepPlan gridSweepPlan(const Tuning& tuning);
/// Returns the plan of a TIN, which has no coarse phase.
[[nodiscard]] SweepPlan tinSweepPlan(const Tuning& tuning);

}  // namespace sand
