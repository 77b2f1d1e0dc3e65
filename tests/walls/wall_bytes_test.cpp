// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

TEST(WallBytes, GiveBackTheWholeWall) {
    for (const char* name : {"tiled_3x4.toml", "flex_cave.toml", "desktop.toml"}) {
        const Wall wall = config(name);
        EXPECT_EQ(Wall::decode(wall.encode()), wall) << name;
    }
}

TEST(WallBytes, AreRefusedWhenCutShortAnywhereOrTooLong) {
    files::Bytes bytes = config("desktop.toml").encode();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_THROW((void)Wall::decode(std::span(bytes).first(size)), files::FormatError) << size;
    }
    bytes.push_back(0);
    EXPECT_THROW((void)Wall::decode(bytes), files::FormatError);
}

TEST(WallBytes, DamagedGiveAWallThatCanBeLaidOutOrAreRefused) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const files::Bytes whole = config("tiled_3x4.toml").encode();
    int refused = 0;
    for (int round = 0; round < 3000; ++round) {
        files::Bytes bytes = whole;
        bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1 << random() % 8);
        try {
            EXPECT_EQ(wallCanvas(Wall::decode(bytes)).tiles.size(), 12U);
        } catch (const files::FormatError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace walls
