// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// The wall in letters: the grid as the viewer sees it, and below it the explicit screens, unfolded along the edges
/// where they join, as one would lay a paper room out flat. A box holds the rank and, for screens, the name.
[[nodiscard]] std::string textMap(const Wall& wall);

}  // namespace walls
