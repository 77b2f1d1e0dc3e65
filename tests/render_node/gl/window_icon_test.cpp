// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/window_icon.hpp"

#include <gtest/gtest.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <cstring>
#include <vector>

namespace {

struct Icon {
    int side = 0;  // [pixel]
    std::vector<std::array<unsigned char, 4>> pixels;

    /// Returns how many pixels have the colour of the pixel (x, y), from there in the direction (dx, dy).
    [[nodiscard]] int alike(int x, int y, int dx, int dy) const {
        const auto at = [&](int i) { return pixels.at(static_cast<std::size_t>((y + i * dy) * side + x + i * dx)); };
        int count = 0;
        while (count < side && at(count) == at(0)) {
            ++count;
        }
        return count;
    }
};
std::vector<Icon> icons;

}  // namespace

// Takes the place of GLFW's function, which hands the icons to the desktop.
extern "C" void glfwSetWindowIcon(GLFWwindow* /*window*/, int count, const GLFWimage* images) {
    for (const GLFWimage& image : std::vector(images, images + count)) {
        Icon& icon = icons.emplace_back(Icon{image.width, {}});
        ASSERT_EQ(image.width, image.height);
        icon.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
        std::memcpy(icon.pixels.data(), image.pixels, 4 * icon.pixels.size());
    }
}

namespace {

TEST(WindowIcon, HasAFrameOfTheSameWidthOnAllSides) {
    icons.clear();
    render_node::setIcon(nullptr);
    ASSERT_EQ(icons.size(), 3U);
    // The frame lies beyond 0.86 of the way from the middle to a side. It has the pixels whose centres lie there.
    for (const auto& [icon, width] : {std::pair(icons[0], 1), {icons[1], 3}, {icons[2], 9}}) {
        const int middle = icon.side / 2, last = icon.side - 1;
        EXPECT_EQ(icon.alike(0, middle, 1, 0), width) << icon.side << ", left";
        EXPECT_EQ(icon.alike(last, middle, -1, 0), width) << icon.side << ", right";
        EXPECT_EQ(icon.alike(middle, 0, 0, 1), width) << icon.side << ", top";
        EXPECT_EQ(icon.alike(middle, last, 0, -1), width) << icon.side << ", bottom";
    }
}

}  // namespace
