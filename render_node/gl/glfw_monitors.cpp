// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/glfw_monitors.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace render_node {

std::span<GLFWmonitor*> glfwMonitors() {
    int count = 0;
    GLFWmonitor** first = glfwGetMonitors(&count);
    return {first, static_cast<std::size_t>(count)};
}

ScreenRect areaOf(GLFWmonitor* monitor) {
    ScreenRect area;
    glfwGetMonitorPos(monitor, &area.low.x, &area.low.y);
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    area.high = area.low + (mode == nullptr ? glm::ivec2(0) : glm::ivec2(mode->width, mode->height));
    return area;
}

bool hasMode(GLFWmonitor* monitor, glm::ivec2 pixels) {
    int count = 0;
    const GLFWvidmode* modes = glfwGetVideoModes(monitor, &count);
    return std::ranges::any_of(std::span(modes, static_cast<std::size_t>(count)),
                               [&](const GLFWvidmode& mode) { return glm::ivec2(mode.width, mode.height) == pixels; });
}

}  // namespace render_node
