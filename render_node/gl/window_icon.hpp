// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

struct GLFWwindow;

namespace render_node {

/// Gives the window Sandwall's icon: a furrow in sand.
void setIcon(GLFWwindow* window);

}  // namespace render_node
