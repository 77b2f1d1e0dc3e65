// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace shapes {

/// Number of levels of detail. Level l of a chunk uses every 2^l-th vertex of the sand, so that a coarser level only
/// smooths the surface between its vertices.
inline constexpr int kLevels = 5;

}  // namespace shapes
