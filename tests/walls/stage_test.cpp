// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "tests/support/seed.hpp"
#include "walls/projection.hpp"

namespace walls {
namespace {

glm::dvec3 apply(const glm::dmat4& matrix, glm::dvec3 point) { return glm::dvec3(matrix * glm::dvec4(point, 1)); }

void expectNear(glm::dvec3 got, glm::dvec3 want) {
    EXPECT_LT(glm::distance(got, want), 1e-12) << got.x << ", " << got.y << ", " << got.z;
}

TEST(Stage, LaysAnUntiltedFieldFlatWithNorthAwayFromTheViewer) {
    const Stage stage{{1, 0.8, -2}, 3, 0, 0};
    const glm::dmat4 toRoom = stageToRoom(stage, 6, 4, 0.5);  // half a metre per scene unit
    expectNear(apply(toRoom, {3, 2, 0.5}), {1, 0.8, -2});
    expectNear(apply(toRoom, {0, 0, 0.5}), {-0.5, 0.8, -1});  // south-west
    expectNear(apply(toRoom, {6, 4, 0.5}), {2.5, 0.8, -3});   // north-east
    expectNear(apply(toRoom, {3, 2, 1.5}), {1, 1.3, -2});     // one unit higher
}

TEST(Stage, ScalesTheLongerSideWhicheverItIs) {
    const glm::dmat4 toRoom = stageToRoom({{0, 0, 0}, 3, 0, 0}, 4, 6, 0);
    expectNear(apply(toRoom, {2, 6, 0}), {0, 0, -1.5});
    expectNear(apply(toRoom, {4, 3, 0}), {1, 0, 0});
}

TEST(Stage, TiltRaisesTheNorthEdgeAndTurnsTheSurfaceToTheViewer) {
    const glm::dmat4 toRoom = stageToRoom({{0, 1, 0}, 2, 30, 0}, 2, 2, 0);
    expectNear(apply(toRoom, {1, 2, 0}), {0, 1 + std::sin(glm::radians(30.0)), -std::cos(glm::radians(30.0))});
    const glm::dvec3 up(toRoom * glm::dvec4(0, 0, 1, 0));
    expectNear(up, {0, std::cos(glm::radians(30.0)), std::sin(glm::radians(30.0))});
    const glm::dvec3 upright(stageToRoom({{0, 1, 0}, 2, 90, 0}, 2, 2, 0) * glm::dvec4(0, 0, 1, 0));
    expectNear(upright, {0, 0, 1});
}

TEST(Stage, TurnIsCounterClockwiseSeenFromAbove) {
    const glm::dmat4 toRoom = stageToRoom({{0, 0, 0}, 2, 0, 90}, 2, 2, 0);
    expectNear(apply(toRoom, {2, 1, 0}), {0, 0, -1});  // east now points away from the viewer
    expectNear(apply(toRoom, {1, 2, 0}), {-1, 0, 0});  // north to the left
}

TEST(Stage, IsARigidMotionAndAScale) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> angle(-90, 90), size(0.1, 5);
    for (int round = 0; round < 100; ++round) {
        const double width = size(random), height = size(random);
        const Stage stage{{size(random), size(random), -size(random)}, size(random), angle(random), 2 * angle(random)};
        const glm::dmat3 linear(stageToRoom(stage, width, height, size(random)));
        const double scale = stage.width / std::max(width, height);
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                EXPECT_NEAR(glm::dot(linear[i], linear[j]), i == j ? scale * scale : 0, 1e-9 * scale * scale);
            }
        }
        EXPECT_NEAR(glm::determinant(linear), scale * scale * scale, 1e-9 * scale * scale * scale) << "mirrored";
    }
}

TEST(Stage, RefusesAFieldWithoutSize) {
    EXPECT_THROW((void)stageToRoom({}, 0, 1, 0), std::invalid_argument);
    EXPECT_THROW((void)stageToRoom({}, 1, std::nan(""), 0), std::invalid_argument);
}

}  // namespace
}  // namespace walls
