// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// References to a TIN, as drawing and forces read it. The triangles include holes, which have no ground.
struct SurfaceView {
    const Triangles& triangles;
    const std::vector<double>& heights;      // by vertex [unit = cell size / 2^16]; meaningless without a vertex
    std::int32_t spacing = kLatticePerCell;  // distance of the points that a tool puts into the sand [probe unit]
};

}  // namespace sand::tin
