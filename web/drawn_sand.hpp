// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/surface.hpp"

namespace web {

/// The sand as a page draws it: a grid's heights, or a TIN's triangles.
struct DrawnSand {
    bool meshed = false;
    std::vector<std::int32_t> heights;  // of a grid, row by row from the south-west [unit]
    std::vector<std::uint8_t> holes;    // of a grid with ground: 1 for a cell that has none
    std::vector<float> places;          // of a TIN's vertices: x, y, z [cell]
    std::vector<std::int32_t> corners;  // of a TIN's triangles

    /// Takes the heights, or the triangles.
    void take(const sand::Surface& surface);
    /// Takes the holes, which never change in a session. Returns whether there are any.
    bool takeHoles(const sand::Surface& surface);
};

}  // namespace web
