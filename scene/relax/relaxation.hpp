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

struct Manner {
    bool settle = false;                                                 // by sand::settle() instead of sweep by sweep
    std::int64_t mostSweeps = std::numeric_limits<std::int64_t>::max();  // not of settle()
    const base::Executor* executor = nullptr;                            // not for settle()
    std::function<void(sand::grid::Erosion&)> afterSweep{};              // may be empty; not called by settle()
};

struct Relaxed {
    bool settled = false;  // by settle(): it does not know ground, and sweeps take its place where there is some
    std::int64_t sweeps = 0;
    int iterations = 0;  // of settle()
    bool atRest = false;
    std::optional<sand::grid::Certificate> certificate;  // not with a ground, on which nobody knows the right pile
};

/// Lets the sand of a grid slide by its rules. The first n sweeps are the same however many follow.
[[nodiscard]] Relaxed relax(GridSand& sand, const Manner& manner);

}  // namespace scene::relax
