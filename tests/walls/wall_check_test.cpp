// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_check.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <string>

#include "tests/support/seed.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

Screen moved(Screen screen, glm::dvec3 by) {
    return {screen.lowerLeft + by, screen.lowerRight + by, screen.upperLeft + by};
}

TEST(Contact, OfNeighboursIsNone) {
    const Screen screen = plainScreen();  // 0.8 x 0.6 m
    EXPECT_EQ(contactOf(screen, moved(screen, {0.8, 0, 0})), Contact::none) << "edge to edge";
    EXPECT_EQ(contactOf(screen, moved(screen, {0.795, 0, 0})), Contact::none) << "a tape measure's millimetres";
    EXPECT_EQ(contactOf(screen, moved(screen, {0.795, 0.595, 0})), Contact::none) << "corner to corner";
    EXPECT_EQ(contactOf(screen, moved(screen, {0, 0, 0.1})), Contact::none) << "one before the other";
    EXPECT_EQ(contactOf(screen, {{-0.4, 0, 0.6}, {0.4, 0, 0.6}, {-0.4, 0, 0}}), Contact::none) << "a floor at its foot";
}

TEST(Contact, IsFoundWhicheverScreenComesFirstAndHoweverTheyAreTurned) {
    const Screen screen = plainScreen();
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> angle(-3, 3);
    struct Case {
        Screen other;
        Contact contact;
    };
    const std::vector<Case> cases{
        {screen, Contact::overlapping},
        {moved(screen, {0.78, 0, 0}), Contact::overlapping},
        {{{-0.1, 0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.2, 0}}, Contact::overlapping},      // one within the other
        {{{0, -0.1, 0}, {0.6, 0.5, 0}, {-0.3, 0.2, 0}}, Contact::overlapping},        // turned in the plane
        {{{0.6, -0.35, 0}, {1.1, 0.15, 0}, {0.35, -0.1, 0}}, Contact::none},          // beside a corner
        {{{-0.4, 0.2, 0.3}, {0.4, 0.2, 0.3}, {-0.4, 0.2, -0.3}}, Contact::crossing},  // through the middle
        {{{-0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {-0.1, 0.2, -0.3}}, Contact::crossing},  // no edge meets another edge
        {{{-0.4, 0.2, 0.3}, {0.4, 0.2, 0.3}, {-0.4, 0.2, 0.001}}, Contact::none},     // ends at the plane
        {{{0.45, 0.2, 0.3}, {0.9, 0.2, 0.3}, {0.45, 0.2, -0.3}}, Contact::none},      // passes beside it
    };
    for (std::size_t i = 0; i < cases.size(); ++i) {
        for (int round = 0; round < 20; ++round) {
            const glm::dmat3 turn(glm::rotate(glm::dmat4(1), angle(random),
                                              glm::normalize(glm::dvec3(angle(random), angle(random), 3.5))));
            const auto turned = [&](const Screen& s) {
                return Screen{turn * s.lowerLeft, turn * s.lowerRight, turn * s.upperLeft};
            };
            EXPECT_EQ(contactOf(turned(screen), turned(cases[i].other)), cases[i].contact) << "case " << i;
            EXPECT_EQ(contactOf(turned(cases[i].other), turned(screen)), cases[i].contact) << "case " << i;
        }
    }
}

TEST(PixelShape, MayBeStretchedOnlyAsTheDisplayStretchesHalves) {
    Tile tile;
    tile.screen = {{0, 0, 0}, {1.6, 0, 0}, {0, 0.9, 0}};
    struct Case {
        Stereo stereo;
        glm::ivec2 pixels;
        bool good;
    };
    for (const Case& c : {Case{Stereo::mono, {1920, 1080}, true},
                          {Stereo::mono, {960, 1080}, false},
                          {Stereo::sideBySide, {1920, 1080}, true},
                          {Stereo::sideBySide, {960, 1080}, true},
                          {Stereo::sideBySide, {1920, 540}, false},
                          {Stereo::topBottom, {1920, 540}, true},
                          {Stereo::topBottom, {960, 1080}, false},
                          {Stereo::topBottom, {1920, 1080}, true},
                          {Stereo::mono, {1920, 1092}, false},
                          {Stereo::sideBySide, {960, 1092}, false},
                          {Stereo::rowInterlaced, {1920, 540}, false}}) {
        tile.pixels = c.pixels;
        EXPECT_EQ(!pixelFault(c.stereo, tile).has_value(), c.good)
            << stereoName(c.stereo) << " " << c.pixels.x << "x" << c.pixels.y;
    }
}

TEST(ShownIn, GivesEveryTileTheOutputsOfTheMode) {
    for (const auto& [stereo, mode] : valuesOf(Stereo{})) {
        const Wall wall = shownIn(config("tiled_3x4.toml"), stereo);
        EXPECT_EQ(wall.stereo, stereo);
        ASSERT_EQ(wall.tiles.size(), 12U);
        for (const Tile& tile : wall.tiles) {
            EXPECT_EQ(tile.outputs, outputsOf(stereo, tile.name)) << mode;
            EXPECT_EQ(tile.pixels, glm::ivec2(1024, 768));
        }
        EXPECT_EQ(Wall::decode(wall.encode()), wall) << mode;
    }
}

TEST(ShownIn, KeepsTheWindowsThatStillFit) {
    const Wall wall = config("projection_screen.toml");
    EXPECT_EQ(shownIn(wall, Stereo::passive), wall);
    const Wall mono = shownIn(wall, Stereo::mono);
    ASSERT_EQ(mono.tiles[0].outputs.size(), 1U);
    EXPECT_EQ(mono.tiles[0].outputs[0].window, glm::ivec2(0, 0));
    const Wall again = shownIn(mono, Stereo::passive);
    EXPECT_EQ(again.tiles[0].outputs[1].window, std::nullopt);
}

TEST(ShownIn, FillsTheScreenOfAThreeDTelevisionInMono) {
    const Wall wall = config("top_bottom.toml");
    EXPECT_EQ(outputPixels(wall.stereo, wall.tiles[0].pixels), glm::ivec2(1920, 1080));
    const Wall mono = shownIn(wall, Stereo::mono);
    EXPECT_EQ(mono.tiles[0].pixels, glm::ivec2(1920, 1080));
    EXPECT_EQ(mono.grid->tilePixels, glm::ivec2(1920, 1080));
    const Wall beside = shownIn(wall, Stereo::sideBySide);
    EXPECT_EQ(beside.tiles[0].pixels, glm::ivec2(960, 1080));
    EXPECT_EQ(pixelFault(Stereo::sideBySide, beside.tiles[0]), std::nullopt);
    EXPECT_EQ(shownIn(config("portable.toml"), Stereo::mono).tiles[0].pixels, glm::ivec2(1024, 768)) << "not stretched";
}

TEST(ViewerCheck, FindsSwappedEyes) {
    Wall wall = config("tiled_3x4.toml");
    EXPECT_EQ(viewerFault(wall), std::nullopt);
    wall.viewer.right = {-1, 0, 0};
    EXPECT_NE(viewerFault(wall).value_or("").find("write right = [1, 0, 0]"), std::string::npos);
    EXPECT_EQ(viewerFault(shownIn(wall, Stereo::mono)), std::nullopt) << "one eye has no order";
    Wall cave = config("flex_cave.toml");
    cave.tiles.resize(1);
    EXPECT_EQ(viewerFault(cave), std::nullopt) << "a screen beside the viewer";
}

TEST(EyeCheck, AsksForEveryEyeThatIsDrawn) {
    Wall wall = config("flex_cave.toml");
    wall.viewer.eye = {1.58, 1.7, 0};  // the right eye is inside the right screen
    EXPECT_NE(eyeFault(wall, wall.tiles[2]).value_or("").find("right eye"), std::string::npos);
    EXPECT_EQ(eyeFault(wall, wall.tiles[1]), std::nullopt);
    EXPECT_EQ(eyeFault(shownIn(wall, Stereo::left), wall.tiles[2]), std::nullopt);
    EXPECT_EQ(eyeFault(shownIn(wall, Stereo::mono), wall.tiles[2]), std::nullopt) << "2 cm before it";
}

}  // namespace
}  // namespace walls
