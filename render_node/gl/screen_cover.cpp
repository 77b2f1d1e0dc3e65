// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/screen_cover.hpp"

namespace render_node {

std::int64_t hiddenPixels(const ScreenRect& window, std::span<const ScreenRect> monitors) {
    const glm::i64vec2 size = glm::i64vec2(window.high) - glm::i64vec2(window.low);
    if (size.x <= 0 || size.y <= 0) {
        return 0;
    }
    if (monitors.empty()) {
        return size.x * size.y;
    }
    const ScreenRect& monitor = monitors.front();
    const glm::ivec2 low = glm::clamp(monitor.low, window.low, window.high);
    const glm::ivec2 high = glm::clamp(monitor.high, window.low, window.high);
    const std::span<const ScreenRect> others = monitors.subspan(1);
    if (low.x >= high.x || low.y >= high.y) {
        return hiddenPixels(window, others);
    }
    // Four strips remain: one above the monitor, one below it, and two beside it.
    return hiddenPixels({window.low, {window.high.x, low.y}}, others) +
           hiddenPixels({{window.low.x, high.y}, window.high}, others) +
           hiddenPixels({{window.low.x, low.y}, {low.x, high.y}}, others) +
           hiddenPixels({{high.x, low.y}, {window.high.x, high.y}}, others);
}

}  // namespace render_node
