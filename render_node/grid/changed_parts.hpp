// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <span>
#include <vector>

#include "shapes/grid/vertices.hpp"

namespace render_node {

/// Largest number of parts for one update.
inline constexpr int kMostChangedParts = 36;

struct ChangedPart {
    sand::CellRect cells;
    /// Heights before the change, in the overwritten cells of this part and up to `reach` cells around it.
    shapes::HeightRange before;
};

/// Joins the overwritten rectangles to at most kMostChangedParts disjoint rectangles. The area is divided into equal
/// squares. Each result covers the overwritten cells in one square.
///
/// The squares are as small as kMostChangedParts allows, and at least 32 cells wide. Small parts follow the sand
/// closely, and a list of few parts is quick to read.
[[nodiscard]] std::vector<ChangedPart> changedParts(std::span<const shapes::GridVertices::Overwritten> overwritten,
                                                    int reach);

}  // namespace render_node
