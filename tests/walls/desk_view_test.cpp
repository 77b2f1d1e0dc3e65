// SPDX-License-Identifier: Apache-2.0
#include "walls/desk_view.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/support/seed.hpp"
#include "tests/walls/sample_walls.hpp"
#include "walls/window_size.hpp"

namespace walls {
namespace {

const StagedField kField{4, 2, 0.5};

/// Returns where a wall of one tile shows a place of the scene [share of the side], from the lower left.
glm::dvec2 shownAt(const Wall& wall, const DeskView& view, glm::dvec3 place) {
    const View seen = viewOf(wall, wall.tiles.front(), Eye::middle);
    const glm::dvec4 clip = seen.viewProjection * view.sceneToRoom() * glm::dvec4(place, 1);
    return (glm::dvec2(clip.x, clip.y) / clip.w + 1.0) / 2.0;
}

glm::dvec3 roomOf(const DeskView& view, glm::dvec3 place) {
    return glm::dvec3(view.sceneToRoom() * glm::dvec4(place, 1));
}

void expectShown(const Wall& wall, const DeskView& view, const TerrainBox& box) {
    expectShown(wall, view.sceneToRoom(), shapes::Box{box.low, box.high});
}

TEST(DeskView, BeginsWithTheStageOfTheWallFile) {
    const Wall wall = config("desktop.toml");
    EXPECT_EQ(DeskView(wall, kField).sceneToRoom(), stageToRoom(wall.stage, 4, 2, 0.5));
}

TEST(DeskView, ZoomsToThePointSoThatThePlaceUnderThePointerStays) {
    const Wall wall = config("desktop.toml");
    const glm::dvec3 place(1.2, 0.4, 0.7);
    DeskView view(wall, kField);
    view.turn(0.1, 0.1);
    const glm::dvec2 before = shownAt(wall, view, place);
    const glm::dvec2 elsewhere = shownAt(wall, view, {3, 1, 0.5});
    for (const double notches : {-1.0, -3.0, 2.5, 0.5}) {
        view.zoom(notches, roomOf(view, place));
        EXPECT_LT(glm::distance(shownAt(wall, view, place), before), 1e-9);
    }
    EXPECT_NEAR(view.orbit().zoom, std::exp2(0.25), 1e-12) << "one notch nearer in all";
    EXPECT_GT(glm::distance(shownAt(wall, view, {3, 1, 0.5}), elsewhere), 0.01);
}

TEST(DeskView, PansWithThePlaceUnderThePointer) {
    const Wall wall = config("desktop.toml");
    DeskView view(wall, kField);
    view.turn(0.2, -0.1);
    view.zoom(-4, wall.stage.centre);
    const glm::dvec3 before = roomOf(view, {1, 1, 0.6});
    view.pan({0.05, -0.02, 0});
    EXPECT_LT(glm::distance(roomOf(view, {1, 1, 0.6}), before + glm::dvec3(0.05, -0.02, 0)), 1e-12);
}

TEST(DeskView, TurnsAboutThePlaceInTheMiddleOfTheStage) {
    const Wall wall = config("desktop.toml");
    DeskView view(wall, kField);
    view.pan({0.1, 0.03, 0.02});
    const glm::dmat4 toScene = glm::inverse(view.sceneToRoom());
    const glm::dvec3 middle(toScene * glm::dvec4(wall.stage.centre, 1));
    view.turn(0.3, 0.2);
    EXPECT_LT(glm::distance(roomOf(view, middle), wall.stage.centre), 1e-12);
}

TEST(DeskView, HasLimitsThatDoNotLoseTheSand) {
    const Wall wall = config("desktop.toml");
    DeskView view(wall, kField);
    view.frame({{0, 0, 0}, {4, 2, 1}});
    const double framed = view.orbit().zoom;
    EXPECT_TRUE(view.zoom(1e30, wall.stage.centre));
    EXPECT_FALSE(view.zoom(1, wall.stage.centre)) << "the limit was reached";
    EXPECT_TRUE(view.zoom(0, wall.stage.centre)) << "the wheel rests";
    EXPECT_DOUBLE_EQ(view.orbit().zoom, framed / 4);
    EXPECT_TRUE(view.zoom(-1e30, wall.stage.centre));
    EXPECT_FALSE(view.zoom(-1, wall.stage.centre));
    const double most = view.orbit().zoom;
    EXPECT_GT(most, 8);
    EXPECT_LE(most, DeskView::kMostZoom);
    for (const double corner : {0.0, 4.0}) {
        EXPECT_LT(wall.viewer.eye.z - roomOf(view, {corner, 2, 0}).z, wall.clip.far) << "the far edge is drawn";
    }
    view.pan({1e30, -1e30, 1e30});
    EXPECT_LT(glm::length(view.orbit().aim), 20);
    view.pan({-1e30, 1e30, -1e30});
    EXPECT_LT(glm::length(view.orbit().aim), 20);
}

TEST(DeskView, FramingKeepsAViewThatShowsAll) {
    const Wall wall = config("desktop.toml");
    const StagedField square{2, 2, 0.2};
    DeskView view(wall, square);
    view.turn(0.1, 0.1);
    view.zoom(-5, {0.1, 1, 0});
    view.pan({0.1, 0, 0});
    view.frame({{0, 0, 0.2}, {2, 2, 0.2}});
    EXPECT_EQ(view.orbit(), Orbit{});
}

TEST(DeskView, FramesAMountainThatTheStageCutsOff) {
    const Wall wall = config("desktop.toml");
    DeskView view(wall, {2, 2, 0.4});
    const TerrainBox mountain{{0, 0, 0}, {2, 2, 1.6}};
    EXPECT_GT(shownAt(wall, view, {1, 2, 1.6}).y, 1) << "the summit is above the screen";
    view.frame(mountain);
    expectShown(wall, view, mountain);
    EXPECT_LT(view.orbit().zoom, 1);
    // It is as large as it can be: something touches the margin of 2 % on two opposite sides.
    glm::dvec2 low(1), high(0);
    for (unsigned i = 0; i < 8; ++i) {
        const glm::dvec2 shown =
            shownAt(wall, view, {(i & 1U) != 0 ? 2 : 0, (i & 2U) != 0 ? 2 : 0, (i & 4U) != 0 ? 1.6 : 0});
        low = glm::min(low, shown);
        high = glm::max(high, shown);
    }
    EXPECT_NEAR(std::max(high.x - low.x, high.y - low.y), 0.96, 1e-9);
}

TEST(DeskView, FramesEveryBoxOnEveryDesktop) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 500; ++i) {
        Wall wall = config("desktop.toml");
        wall.stage.tiltDegrees = between(0, 90);
        wall.stage.turnDegrees = between(-180, 180);
        wall.stage.width = between(0.05, 3);
        wall.stage.centre += glm::dvec3(between(-0.3, 0.3), between(-0.3, 0.3), between(-1, 0.2));
        wall.viewer.eye += glm::dvec3(between(-0.3, 0.3), between(-0.3, 0.3), between(-0.2, 1));
        const StagedField field{between(0.1, 10), between(0.1, 10), between(-5, 5)};
        const double low = between(-5, 5);
        const TerrainBox box{{0, 0, low}, {field.width, field.height, low + between(0, 10)}};
        DeskView view(wall, field);
        view.frame(box);
        expectShown(wall, view, box);
        if (HasFailure()) {
            FAIL() << "wall " << i;
        }
    }
}

/// Returns the walls that people may turn, in windows of many shapes.
std::vector<Wall> desktops() {
    std::vector<Wall> walls;
    const Wall desktop = config("desktop.toml");
    for (const glm::ivec2 window : {glm::ivec2(0), {1920, 1080}, {1024, 768}, {800, 800}, {720, 1280}, {3440, 1440}}) {
        walls.push_back(shownInWindow(desktop, window));
    }
    for (const char* name : {"tiled_3x4.toml", "portable.toml"}) {
        walls.push_back(loadWallAs((configFolder() / name).string(), "mono"));
    }
    return walls;
}

TEST(DeskView, FramesTheBoxWithItsBoardsInEveryWindow) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const std::vector<Wall> walls = desktops();
    for (int i = 0; i < 400; ++i) {
        const Wall& wall = walls[static_cast<std::size_t>(i) % walls.size()];
        ASSERT_TRUE(isDesktop(wall));
        const StagedField field{between(0.1, 10), between(0.1, 10), between(-5, 5)};
        const double low = field.referenceZ - between(0, 2);
        const shapes::Box box =
            shapes::boxOutline({field.width, field.height}, low, low + between(0, i % 2 == 0 ? 0.1 : 10));
        DeskView view(wall, field);
        view.frame({box.low, box.high});
        expectShown(wall, view.sceneToRoom(), box);
        if (HasFailure()) {
            FAIL() << "wall " << i << ", " << wall.name;
        }
    }
}

TEST(DeskView, KeepsTheStageForLevelSandWithItsBoards) {
    for (const Wall& wall : desktops()) {
        const StagedField square{2, 2, 0.2};
        const shapes::Box box = shapes::boxOutline({2, 2}, 0.2, 0.2);
        DeskView view(wall, square);
        view.frame({box.low, box.high});
        EXPECT_EQ(view.orbit(), Orbit{}) << wall.name << ", " << wall.tiles.front().pixels.x;
    }
}

}  // namespace
}  // namespace walls
