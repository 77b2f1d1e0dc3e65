// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// Returns a drawing of the wall as SVG: front view and plan at one scale. It shows every tile's rank, name and pixels,
/// and the bezels and sizes in figures. It also shows the viewer, and the outline of the sand as if its field were
/// square. On a flat wall the front view shows the sand as the middle eye sees it on the wall. Otherwise the front view
/// shows the sand at its place in the room.
[[nodiscard]] std::string drawingOf(const Wall& wall);

}  // namespace walls
