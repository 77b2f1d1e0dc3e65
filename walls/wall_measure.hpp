// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "walls/wall.hpp"

/// What a tape measure would find on the tiles as they were made, not as they were meant. Pure functions.
namespace walls {

/// Gaps between neighbours in one direction of the grid.
struct Gaps {
    int count = 0;
    double least = 0, most = 0;  // [m], < 0 where tiles overlap
    double aslant = 0;           // [m], by how much neighbours stand off each other's line at most
};
/// From right edges to left edges, and from lower edges to upper edges.
[[nodiscard]] std::array<Gaps, 2> gapsOf(const Wall& wall);

enum class Edge : std::uint8_t { left, right, bottom, top };
[[nodiscard]] std::string_view edgeName(Edge edge);

/// Two edges that run along one another: how the screens of a CAVE join.
struct Seam {
    std::size_t first = 0, second = 0;  // indices into wall.tiles, the first before the second
    Edge edgeOfFirst{}, edgeOfSecond{};
    double apart = 0;    // [m], at the worse of the two ends
    double degrees = 0;  // between the screens, as the viewer sees them: 180 for one plane, 90 for a room's corner
};
inline constexpr double kSeam = 0.05;  // [m], edges farther apart do not belong together
/// All seams that have an explicit screen.
[[nodiscard]] std::vector<Seam> seamsOf(const Wall& wall);

}  // namespace walls
