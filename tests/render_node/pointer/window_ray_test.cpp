// SPDX-License-Identifier: Apache-2.0
#include "render_node/pointer/window_ray.hpp"

#include <gtest/gtest.h>

#include "walls/projection.hpp"

namespace render_node {
namespace {

/// Returns a wall of two tiles of 100 x 50 pixels and 1 m x 0.5 m, side by side behind a bezel of 0.2 m. Their windows
/// stand on one display, without a gap, if `placed`.
walls::Wall pair(bool placed, walls::Stereo stereo = walls::Stereo::mono) {
    walls::Wall wall;
    wall.viewer.eye = {0.6, 1, 2};
    wall.stereo = stereo;
    walls::Grid grid;
    grid.columns = 2;
    grid.tileSize = {1, 0.5};
    grid.bezel = {0.2, 0};
    grid.tilePixels = {100, 50};
    grid.lowerLeft = {0, 0, 0};
    wall.grid = grid;
    wall.tiles = walls::tilesOf(grid, stereo);
    if (placed) {
        wall.tiles[0].outputs[0].window = glm::ivec2(10, 20);
        wall.tiles[1].outputs[0].window = glm::ivec2(110, 20);
    }
    return wall;
}

void expectPoint(const walls::Wall& wall, glm::dvec2 pixel, double x, double y) {
    const glm::dvec3 point = roomPoint(wall, wall.tiles[0], {0, pixel});
    EXPECT_NEAR(point.x, x, 1e-12);
    EXPECT_NEAR(point.y, y, 1e-12);
    EXPECT_NEAR(point.z, 0, 1e-12);
}

TEST(WindowRay, AWindowsPixelsFillTheScreenFromTheTopLeft) {
    expectPoint(pair(true), {0, 0}, 0, 0.5);
    expectPoint(pair(true), {50, 10}, 0.5, 0.4);
    expectPoint(pair(true), {25, 50}, 0.25, 0);
}

TEST(WindowRay, OverTheWindowOfTheNextTileItIsOnThatTilesScreen) {
    expectPoint(pair(true), {99, 25}, 0.99, 0.25);
    expectPoint(pair(true), {100, 25}, 1.2, 0.25);  // the bezel is not on the display
    expectPoint(pair(true), {150, 25}, 1.7, 0.25);
}

TEST(WindowRay, ElsewhereTheScreenIsExtendedBeyondItsEdges) {
    expectPoint(pair(false), {150, 25}, 1.5, 0.25);
    expectPoint(pair(true), {-30, 25}, -0.3, 0.25);
    expectPoint(pair(true), {150, 75}, 1.5, -0.25);  // below both windows
    walls::Wall otherDisplay = pair(true);
    otherDisplay.tiles[1].place.display = ":7";
    expectPoint(otherDisplay, {150, 25}, 1.5, 0.25);
}

TEST(WindowRay, PackedEyesShowEachPlaceTwice) {
    // The buffer is twice as wide as one eye's picture: 200 x 50 pixels.
    expectPoint(pair(false, walls::Stereo::sideBySide), {50, 25}, 0.5, 0.25);
    expectPoint(pair(false, walls::Stereo::sideBySide), {150, 25}, 0.5, 0.25);
    expectPoint(pair(false, walls::Stereo::topBottom), {50, 25}, 0.5, 0.25);
    expectPoint(pair(false, walls::Stereo::topBottom), {50, 75}, 0.5, 0.25);
}

TEST(WindowRay, TheRayPassesTheSceneAsTheEyeSeesIt) {
    const walls::Stage stage{{0.6, 0.2, -0.5}, 1, 35, 20};
    const glm::dmat4 toRoom = walls::stageToRoom(stage, 4, 3, 0.5);
    const glm::dvec3 place(1.5, 0.7, 0.6);  // scene units
    const glm::dvec3 eye(0.6, 1, 2);
    const glm::dvec3 inRoom(toRoom * glm::dvec4(place, 1));
    const Ray ray = sightRay(eye, eye + 0.25 * (inRoom - eye), toRoom);
    const glm::dvec3 after = ray.from + 4.0 * ray.along;
    EXPECT_LT(glm::distance(after, place), 1e-12);
}

}  // namespace
}  // namespace render_node
