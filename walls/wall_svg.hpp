// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// The wall as a picture (SVG): its front and its plan at one scale, with every tile's rank, name and pixels, bezels
/// and sizes in figures, the viewer, and the outline of the sand if its field is square. In front of a flat wall the
/// sand is drawn where the middle eye sees it on the wall, else where it stands.
[[nodiscard]] std::string drawingOf(const Wall& wall);

}  // namespace walls
