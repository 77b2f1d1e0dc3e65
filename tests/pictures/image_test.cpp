// SPDX-License-Identifier: Apache-2.0
#include "pictures/image.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace pictures {
namespace {

/// Returns a picture in which every pixel has a different colour.
Image numbered(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y)[0] = static_cast<std::uint8_t>(10 + x);
            image.at(x, y)[1] = static_cast<std::uint8_t>(10 + y);
            image.at(x, y)[2] = static_cast<std::uint8_t>(200 - x - y);
        }
    }
    return image;
}

TEST(Image, StartsBlackAndRefusesImpossibleSizes) {
    const Image image(3, 2);
    EXPECT_EQ(image.rgb, std::vector<std::uint8_t>(18, 0));
    EXPECT_THROW(Image(-1, 2), std::invalid_argument);
    EXPECT_THROW(Image(1 << 20, 1 << 20), std::invalid_argument);
}

TEST(Image, CropTakesBackWhatBlitPlaced) {
    const Image tile = numbered(5, 4);
    Image canvas(20, 10);
    blit(canvas, tile, 7, 3);
    EXPECT_EQ(crop(canvas, 7, 3, 5, 4), tile);
    EXPECT_NE(crop(canvas, 6, 3, 5, 4), tile);
    EXPECT_THROW((void)crop(canvas, 16, 3, 5, 4), std::invalid_argument);
}

TEST(Image, BlitLeavesOutWhatFallsOutside) {
    const Image tile = numbered(5, 4);
    for (const auto& [x, y] : {std::pair{-2, -1}, {3, 3}, {-5, 0}, {0, 6}, {-100, 100}}) {
        Image canvas(6, 6);
        blit(canvas, tile, x, y);
        for (int cy = 0; cy < 6; ++cy) {
            for (int cx = 0; cx < 6; ++cx) {
                const bool covered = cx >= x && cx < x + 5 && cy >= y && cy < y + 4;
                EXPECT_EQ(canvas.at(cx, cy)[0], covered ? 10 + cx - x : 0)
                    << x << "," << y << " at " << cx << "," << cy;
            }
        }
    }
}

TEST(Image, TheAssembledWallIsBlackBetweenItsTiles) {
    const Image left = numbered(4, 3);
    const Image right = numbered(4, 3);
    const std::vector<Placed> placed{{&left, 0, 0}, {&right, 6, 0}};
    const Image wall = assemble(10, 3, placed);
    EXPECT_EQ(crop(wall, 0, 0, 4, 3), left);
    EXPECT_EQ(crop(wall, 6, 0, 4, 3), right);
    EXPECT_EQ(crop(wall, 4, 0, 2, 3), Image(2, 3));
}

}  // namespace
}  // namespace pictures
