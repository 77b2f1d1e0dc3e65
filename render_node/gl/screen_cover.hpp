// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace render_node {

/// Pixels from `low` up to, but without, `high`; y down as on an X screen.
struct ScreenRect {
    glm::ivec2 low{0}, high{0};
};

/// How many pixels of a window no monitor shows.
[[nodiscard]] std::int64_t hiddenPixels(const ScreenRect& window, std::span<const ScreenRect> monitors);

}  // namespace render_node
