// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace render_node {

/// Rectangle of pixels from `low` (included) to `high` (excluded). y points down, as on an X screen.
struct ScreenRect {
    glm::ivec2 low{0}, high{0};
};

/// Returns the number of a window's pixels that are on no monitor.
[[nodiscard]] std::int64_t hiddenPixels(const ScreenRect& window, std::span<const ScreenRect> monitors);

}  // namespace render_node
