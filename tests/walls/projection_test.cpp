// SPDX-License-Identifier: Apache-2.0
#include "walls/projection.hpp"

#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <stdexcept>
#include <string>

#include "tests/support/seed.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

constexpr double kNear = 0.1, kFar = 50;  // [m]
constexpr double kDistance = 2;           // [m], from the eye to the screen
constexpr double kSeparation = 0.065;     // [m]

const Viewer kViewer{{0, 0.3, kDistance}, kSeparation, {1, 0, 0}};

View plainView(Eye eye) { return viewOf(plainScreen(), eyePosition(kViewer, eye), kNear, kFar); }

void expectEqual(const glm::dmat4& got, const glm::dmat4& want, double tolerance = 1e-12) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            EXPECT_NEAR(got[column][row], want[column][row], tolerance) << "column " << column << ", row " << row;
        }
    }
}

TEST(Eyes, LieHalfTheSeparationToEitherSide) {
    const Viewer viewer{{1, 2, 3}, 0.07, {0, 0, -1}};
    EXPECT_EQ(eyePosition(viewer, Eye::middle), glm::dvec3(1, 2, 3));
    EXPECT_LT(glm::distance(eyePosition(viewer, Eye::left), {1, 2, 3.035}), 1e-15);
    EXPECT_LT(glm::distance(eyePosition(viewer, Eye::right), {1, 2, 2.965}), 1e-15);
}

TEST(Projection, IsThePapersShiftedFrustum) {
    // Dorjgotov et al. 2007, section 5.3: glFrustum(l + d, r + d, bot, top, near, far), d positive for the left eye.
    // Seen from half a separation to the left, the screen lies that much to the right, scaled down to the near plane.
    const double toNear = kNear / kDistance;
    const double l = -0.4 * toNear, r = 0.4 * toNear, bottom = -0.3 * toNear, top = 0.3 * toNear;
    for (const auto& [eye, sign] : {std::pair{Eye::left, 1.0}, {Eye::right, -1.0}, {Eye::middle, 0.0}}) {
        const double d = sign * kSeparation / 2 * toNear;
        const View view = plainView(eye);
        EXPECT_NEAR(view.left, l + d, 1e-15) << eyeName(eye);
        EXPECT_NEAR(view.right, r + d, 1e-15) << eyeName(eye);
        expectEqual(view.projection, glm::frustum(l + d, r + d, bottom, top, kNear, kFar));
        expectEqual(view.view, glm::translate(glm::dmat4(1), -eyePosition(kViewer, eye)));
    }
}

TEST(Projection, PutsTheScreensCornersInThePicturesCorners) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> anywhere(-2, 2), ahead(0.2, 4);
    for (int round = 0; round < 200; ++round) {
        const glm::dmat3 turn(glm::rotate(glm::dmat4(1), anywhere(random) * 2,
                                          glm::normalize(glm::dvec3(anywhere(random), anywhere(random), 2.5))));
        const glm::dvec3 corner(anywhere(random), anywhere(random), anywhere(random));
        const Screen screen{corner, corner + turn[0] * ahead(random), corner + turn[1] * ahead(random)};
        const glm::dvec3 eye =
            corner + turn[0] * anywhere(random) + turn[1] * anywhere(random) + turn[2] * ahead(random);
        const View view = viewOf(screen, eye, kNear, kFar);
        const std::array<std::pair<glm::dvec3, glm::dvec2>, 4> corners{{{screen.lowerLeft, {-1, -1}},
                                                                        {screen.lowerRight, {1, -1}},
                                                                        {screen.upperLeft, {-1, 1}},
                                                                        {screen.upperRight(), {1, 1}}}};
        for (const auto& [point, expected] : corners) {
            const glm::dvec4 clip = view.viewProjection * glm::dvec4(point, 1);
            EXPECT_NEAR(clip.w, screen.distanceTo(eye), 1e-9);
            EXPECT_NEAR(clip.x / clip.w, expected.x, 1e-9);
            EXPECT_NEAR(clip.y / clip.w, expected.y, 1e-9);
        }
        for (const auto& [distance, depth] : {std::pair{kNear, -1.0}, {kFar, 1.0}}) {
            const glm::dvec4 clip = view.viewProjection * glm::dvec4(eye - screen.normal() * distance, 1);
            EXPECT_NEAR(clip.z / clip.w, depth, 1e-9);
        }
    }
}

TEST(Projection, ShowsEveryPointOnTheLineFromTheEye) {
    const Wall cave = config("flex_cave.toml");
    const std::array<glm::dvec3, 3> points{{{0.3, 0.4, -2.5}, {-0.6, 0.5, -0.9}, {0.2, 1.2, -0.4}}};
    for (const Tile& tile : cave.tiles) {
        for (const Eye eye : eyesOf(cave.stereo)) {
            const View view = viewOf(cave, tile, eye);
            for (const glm::dvec3 point : points) {
                const glm::dvec3 shown = shownAt(tile.screen, view, point);
                EXPECT_LT(glm::length(glm::cross(glm::normalize(shown - view.eye), glm::normalize(point - view.eye))),
                          1e-9)
                    << tile.name;
            }
        }
    }
}

TEST(Projection, GivesThePointTheParallaxOfItsDepth) {
    // By similar triangles, a point s behind the screen is separation * s / (s + distance) further right for the right
    // eye than for the left. This is 0 on the screen, negative in front of it, and the whole separation at infinity.
    const View left = plainView(Eye::left), right = plainView(Eye::right);
    for (const double s : {-1.0, -0.5, 0.0, 0.5, 2.0, 40.0}) {
        const glm::dvec3 point(0.1, 0.25, -s);
        const glm::dvec3 parallax = shownAt(plainScreen(), right, point) - shownAt(plainScreen(), left, point);
        EXPECT_NEAR(parallax.x, kSeparation * s / (s + kDistance), 1e-12) << s << " m behind the screen";
        EXPECT_NEAR(parallax.y, 0, 1e-12);
        EXPECT_EQ(parallax.x > 0, s > 0) << "swapped eyes";
    }
}

TEST(Projection, OfTheMiddleLiesBetweenTheEyes) {
    const glm::dvec3 point(-0.2, 0.4, -1.5);
    const glm::dvec3 left = shownAt(plainScreen(), plainView(Eye::left), point);
    const glm::dvec3 right = shownAt(plainScreen(), plainView(Eye::right), point);
    EXPECT_LT(glm::distance(shownAt(plainScreen(), plainView(Eye::middle), point), (left + right) / 2.0), 1e-12);
}

TEST(Projection, RefusesAnEyeThatIsNotBeforeTheScreen) {
    EXPECT_THROW((void)viewOf(plainScreen(), {0, 0, -1}, kNear, kFar), std::invalid_argument);
    EXPECT_THROW((void)viewOf(plainScreen(), {0, 0, 0}, kNear, kFar), std::invalid_argument);
    EXPECT_THROW((void)viewOf(plainScreen(), {0, 0, 1}, 0, kFar), std::invalid_argument);
    EXPECT_THROW((void)viewOf(plainScreen(), {0, 0, 1}, kNear, kNear), std::invalid_argument);
    EXPECT_THROW((void)viewOf(plainScreen(), {0, 0, std::nan("")}, kNear, kFar), std::invalid_argument);
}

TEST(Cave, FacesJoinAlongTheirEdges) {
    const Wall cave = config("flex_cave.toml");
    const auto corners = [](const Screen& s) {
        return std::array<glm::dvec3, 4>{s.lowerLeft, s.lowerRight, s.upperLeft, s.upperRight()};
    };
    int joints = 0;
    for (std::size_t i = 0; i < cave.tiles.size(); ++i) {
        for (std::size_t j = i + 1; j < cave.tiles.size(); ++j) {
            std::vector<glm::dvec3> shared;
            for (const glm::dvec3 a : corners(cave.tiles[i].screen)) {
                for (const glm::dvec3 b : corners(cave.tiles[j].screen)) {
                    if (glm::distance(a, b) < 1e-9) {
                        shared.push_back(a);
                    }
                }
            }
            if (shared.size() != 2) {
                continue;
            }
            ++joints;
            for (const Eye eye : eyesOf(cave.stereo)) {
                const View first = viewOf(cave, cave.tiles[i], eye), second = viewOf(cave, cave.tiles[j], eye);
                for (const double along : {0.0, 0.3, 1.0}) {
                    const glm::dvec3 edge = glm::mix(shared[0], shared[1], along);
                    // In front of, on and behind the edge, both faces show a point at the same place.
                    for (const double depth : {0.4, 1.0, 3.0}) {
                        const glm::dvec3 point = first.eye + (edge - first.eye) * depth;
                        EXPECT_LT(glm::distance(shownAt(cave.tiles[i].screen, first, point), edge), 1e-9);
                        EXPECT_LT(glm::distance(shownAt(cave.tiles[j].screen, second, point), edge), 1e-9);
                    }
                }
            }
        }
    }
    EXPECT_EQ(joints, 5) << "left-front, front-right, and the floor with each";
}

}  // namespace
}  // namespace walls
