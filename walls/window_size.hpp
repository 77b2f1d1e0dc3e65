// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "walls/wall.hpp"

namespace walls {

/// Returns whether the wall file gives the output a place: a monitor, or the place of its window.
[[nodiscard]] inline bool isPlaced(const Output& output) {
    return !output.monitor.empty() || output.window.has_value();
}

/// Returns whether the picture of this wall follows the size of its window: the wall has one output, and the wall file
/// does not place it.
[[nodiscard]] bool followsWindow(const Wall& wall);

inline constexpr int kLeastWindowSide = 16;  // [pixel], of a picture that follows its window

/// Returns the wall as it is shown in a window of `window` pixels. Its only tile gets the pixels of the window, within
/// kLeastWindowSide and kMaxTileSide. The pixels keep their shape. The screen keeps its middle, and becomes wider or
/// higher until it has the shape of the window, so that all that the wall file shows stays in view.
///
/// Returns the wall itself for a window of 0 × 0 pixels, which stands for the size in the wall file. Requires
/// followsWindow(wall).
[[nodiscard]] Wall shownInWindow(Wall wall, glm::ivec2 window /* [pixel] */);

/// Returns the memory of a rank's pictures with their depth, and of the buffers of its windows [byte]. A rank that
/// draws in memory has no windows, and takes less.
[[nodiscard]] std::int64_t frameBufferBytes(const Wall& wall, const Tile& tile);

}  // namespace walls
