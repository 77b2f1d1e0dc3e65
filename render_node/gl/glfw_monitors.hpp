// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "render_node/gl/screen_cover.hpp"

struct GLFWmonitor;

namespace render_node {

/// Returns the monitors that GLFW knows. It learns of monitors that come or go when it processes events.
[[nodiscard]] std::span<GLFWmonitor*> glfwMonitors();
/// Returns the area of a monitor's picture on the X screen.
[[nodiscard]] ScreenRect areaOf(GLFWmonitor* monitor);
/// Returns whether a monitor has a mode of this size [pixel].
[[nodiscard]] bool hasMode(GLFWmonitor* monitor, glm::ivec2 pixels);

}  // namespace render_node
