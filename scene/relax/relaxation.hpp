// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "sand/grid/certificate.hpp"
#include "sand/grid/erosion.hpp"
#include "scene/relax/grid_sand.hpp"

namespace scene::relax {

/// How to relax.
struct Manner {
    bool settle = false;                                                 // by grid::settle() instead of sweep by sweep
    std::int64_t mostSweeps = std::numeric_limits<std::int64_t>::max();  // ignored by settle()
    const base::Executor* executor = nullptr;                            // ignored by settle()
    std::function<void(sand::grid::Erosion&)> afterSweep{};              // may be empty; not called by settle()
};

/// Result of relax().
struct Relaxed {
    bool settled = false;  // whether settle() did it; on ground, which settle() ignores, sweeps replace it
    std::int64_t sweeps = 0;
    int iterations = 0;  // iterations of settle()
    bool atRest = false;
    std::optional<sand::grid::Certificate> certificate;  // nullopt with a ground, on which the right pile is unknown
};

/// Lets the sand of a grid slide by its rules. The first n sweeps do not depend on how many follow.
[[nodiscard]] Relaxed relax(GridSand& sand, const Manner& manner);

}  // namespace scene::relax
