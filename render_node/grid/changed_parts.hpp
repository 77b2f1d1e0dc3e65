// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <span>
#include <vector>

#include "render_node/grid/vertices.hpp"

namespace render_node {

/// Parts of one update at most.
inline constexpr int kMostChangedParts = 36;

/// Joins the rectangles that were overwritten to at most kMostChangedParts disjoint ones: one for each square of a
/// lattice that holds some. Small parts follow the sand closely, and few parts are soon looked through: the squares are
/// as small as this number allows, and have at least 32 cells a side.
[[nodiscard]] std::vector<sand::CellRect> changedParts(std::span<const SandSurface::Overwritten> overwritten);

}  // namespace render_node
