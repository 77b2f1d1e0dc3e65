// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/window_icon.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace render_node {
namespace {

/// Returns the colour at a place of the icon, whose sides are -1 to 1, seen from above.
glm::vec3 iconColour(glm::vec2 at) {
    constexpr float kWood = 0.86F, kFurrow = 0.22F;
    if (std::max(std::abs(at.x), std::abs(at.y)) > kWood) {
        return {0.52F, 0.34F, 0.20F};
    }
    // Light from the left falls on the furrow's right wall and on the left side of its banks.
    const float across = (at.x - 0.35F * std::sin(3 * at.y)) / kFurrow;
    const float slope = across * std::exp(1 - across * across);
    return glm::vec3(0.88F, 0.75F, 0.54F) * (1 + 0.45F * slope);
}

std::vector<std::uint8_t> iconPixels(int side) {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::vec2 at = (glm::vec2(x, y) + 0.5F) * (2.0F / static_cast<float>(side)) - 1.0F;
            const glm::vec3 colour = glm::clamp(iconColour(at), 0.0F, 1.0F);
            for (const float level : {colour.x, colour.y, colour.z, 1.0F}) {
                pixels.push_back(static_cast<std::uint8_t>(std::lround(level * 255)));
            }
        }
    }
    return pixels;
}

}  // namespace

void setIcon(GLFWwindow* window) {
    constexpr std::array<int, 3> kSides{16, 48, 128};  // [pixel], for title bars, task bars and lists of windows
    std::array<std::vector<std::uint8_t>, kSides.size()> pixels;
    std::array<GLFWimage, kSides.size()> images{};
    for (std::size_t i = 0; i < kSides.size(); ++i) {
        pixels[i] = iconPixels(kSides[i]);
        images[i] = {kSides[i], kSides[i], pixels[i].data()};
    }
    glfwSetWindowIcon(window, static_cast<int>(images.size()), images.data());
}

}  // namespace render_node
