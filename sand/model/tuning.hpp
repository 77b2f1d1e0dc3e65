// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/field_forms.hpp"
#include "sand/model/tool.hpp"

namespace sand {

inline constexpr std::int32_t kLargestThreshold =
    1 << 30;                                       // [unit]; no sand slides then, because differences never exceed 2^29
inline constexpr std::int32_t kMostSweeps = 4096;  // most sweeps per step
inline constexpr std::int32_t kMostSweepsToRest = 1 << 20;  // largest Tuning::sweepsPerStep

/// Rules that an operator may change during a session. scene/model/material.hpp computes them once; then they are sent
/// as whole numbers.
struct Tuning {
    /// Largest stable height difference over one cell from west to east: tan(talus) · cell size [unit].
    std::int32_t threshold = 0;
    /// Height difference, over the same distance, beyond which sand at rest starts to slide [unit]. It is at least
    /// `threshold`; a larger value gives hysteresis.
    std::int32_t startThreshold = 0;
    /// Sweeps in each step with which sand beside the tool rests after the settling time. A SweepPlan says how many of
    /// them a step owes.
    std::int32_t sweepsPerStep = 0;
    Tool tool{};

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("threshold", base::limited(it.threshold, 0, kLargestThreshold));
        visit("start_threshold", base::limited(it.startThreshold, it.threshold, kLargestThreshold));
        visit("sweeps_per_step", base::limited(it.sweepsPerStep, 1, kMostSweepsToRest));
        visit("tool", it.tool);
    }
    friend bool operator==(const Tuning&, const Tuning&) = default;
};

}  // namespace sand
