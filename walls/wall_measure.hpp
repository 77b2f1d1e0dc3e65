// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "walls/wall.hpp"

/// Measurements of the finished tiles, as with a tape measure, not of the grid's numbers. All functions are pure.
namespace walls {

/// Gaps between neighbours in one direction of the grid.
struct Gaps {
    int count = 0;
    double least = 0, most = 0;  // [m], < 0 if tiles overlap
    double aslant = 0;           // [m], largest sideways offset between neighbours
};
/// Returns the gaps from right edges to left edges, and from lower edges to upper edges.
[[nodiscard]] std::array<Gaps, 2> gapsOf(const Wall& wall);

enum class Edge : std::uint8_t { left, right, bottom, top };
[[nodiscard]] std::string_view edgeName(Edge edge);

/// Two edges that run along each other, as where the screens of a CAVE join.
struct Seam {
    std::size_t first = 0, second = 0;  // indices into wall.tiles, the first before the second
    Edge edgeOfFirst{}, edgeOfSecond{};
    double apart = 0;    // [m], the larger of the distances at both ends
    double degrees = 0;  // angle between the screens as the viewer sees them: 180 for one plane, 90 for a room's corner
};
inline constexpr double kSeam = 0.05;  // [m], largest distance between the edges of a seam
/// Returns all seams that have an explicit screen.
[[nodiscard]] std::vector<Seam> seamsOf(const Wall& wall);

}  // namespace walls
