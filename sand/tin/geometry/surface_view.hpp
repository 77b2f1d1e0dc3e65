// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// A TIN as whoever draws or feels it sees it, holes without ground and all; nothing here needs the module that the TIN
/// itself lives in.
struct SurfaceView {
    const Triangles& triangles;
    const std::vector<double>& heights;      // by vertex [unit = cell size / 2^16]; anything where no vertex lives
    std::int32_t spacing = kLatticePerCell;  // [probe unit], between the points that a tool puts into the sand
};

}  // namespace sand::tin
