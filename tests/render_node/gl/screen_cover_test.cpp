// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/screen_cover.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using render_node::hiddenPixels;
using render_node::ScreenRect;

TEST(ScreenCover, CountsThePixelsThatNoMonitorShows) {
    const ScreenRect window{{100, 50}, {300, 150}};
    EXPECT_EQ(hiddenPixels(window, {}), 200 * 100);
    const ScreenRect all{{0, 0}, {400, 300}};
    const ScreenRect leftHalf{{0, 0}, {200, 300}};
    const ScreenRect rightHalf{{200, 0}, {400, 300}};
    const ScreenRect inside{{120, 60}, {130, 80}};
    const ScreenRect elsewhere{{300, 0}, {400, 300}};
    EXPECT_EQ(hiddenPixels(window, std::array{all}), 0);
    EXPECT_EQ(hiddenPixels(window, std::array{leftHalf}), 100 * 100);
    EXPECT_EQ(hiddenPixels(window, std::array{leftHalf, rightHalf}), 0);
    EXPECT_EQ(hiddenPixels(window, std::array{leftHalf, leftHalf}), 100 * 100) << "mirrored monitors count once";
    EXPECT_EQ(hiddenPixels(window, std::array{inside}), 200 * 100 - 10 * 20);
    EXPECT_EQ(hiddenPixels(window, std::array{inside, inside, leftHalf}), 100 * 100);
    EXPECT_EQ(hiddenPixels(window, std::array{elsewhere}), 200 * 100);
}

TEST(ScreenCover, CountsEachSideOfAMonitorByItself) {
    const ScreenRect window{{100, 50}, {300, 150}};
    EXPECT_EQ(hiddenPixels(window, std::array{ScreenRect{{0, 0}, {293, 300}}}), 7 * 100) << "right";
    EXPECT_EQ(hiddenPixels(window, std::array{ScreenRect{{107, 0}, {400, 300}}}), 7 * 100) << "left";
    EXPECT_EQ(hiddenPixels(window, std::array{ScreenRect{{0, 0}, {400, 143}}}), 200 * 7) << "below";
    EXPECT_EQ(hiddenPixels(window, std::array{ScreenRect{{0, 57}, {400, 300}}}), 200 * 7) << "above";
}

}  // namespace
