// SPDX-License-Identifier: Apache-2.0
// Compares the bounds of a ball's light with random places where the shaders' formulae are not 0.
#include "render_node/tool/reach.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using shapes::Box;

const glm::dvec3 kBallCentre(0.3, -0.2, 1.1);
constexpr double kBallRadius = 0.4, kLowestSand = -1.5, kHighestSand = 1.7;

/// The formulae of shaders/light.glsl.
bool isInShadow(const glm::dvec3& place, const glm::dvec3& sun) {
    const glm::dvec3 away = (kBallCentre - place) / kBallRadius;
    const double along = glm::dot(away, sun);
    const double miss = std::sqrt(std::max(glm::dot(away, away) - along * along, 0.0));
    return along > -0.2 && along < 20 && miss < 1 + 0.08 + 0.07 * std::max(along, 0.0);
}

/// Returns the cross section of the convex hull of two boxes at a height, if the first box is flat. Above and below the
/// hull it is empty. If the first box is not flat, returns the box around both.
Box hullAt(const std::array<Box, 2>& boxes, double height) {
    const Box &top = boxes.front(), &bottom = boxes.back();
    if (top.low.z != top.high.z || top.low.z == bottom.low.z) {
        return around(top, bottom);
    }
    if (height > top.high.z || height < bottom.low.z) {
        return {glm::dvec3(1), glm::dvec3(-1)};
    }
    const double share = (height - bottom.low.z) / (top.low.z - bottom.low.z);
    return {glm::mix(bottom.low, top.low, share), glm::mix(bottom.high, top.high, share)};
}

bool isWithin(const glm::dvec3& place, const Box& box) {
    constexpr double kRounding = 1e-12;
    return glm::all(glm::lessThanEqual(box.low - kRounding, place)) &&
           glm::all(glm::lessThanEqual(place, box.high + kRounding));
}

class ToolReach : public testing::TestWithParam<glm::dvec3> {
protected:
    glm::dvec3 sun_ = glm::normalize(GetParam());
    render_node::ToolReach reach_{kBallCentre, kBallRadius, sun_};
};

TEST_P(ToolReach, BoundsTheShadowAndNotMuchMore) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> wide(-1, 1), height(kLowestSand, kHighestSand);
    const std::array<Box, 2> boxes = reach_.shadowBetween(kLowestSand, kHighestSand);
    int inShadow = 0, inHull = 0;
    for (int i = 0; i < 400'000; ++i) {
        const double z = height(random);
        // Places around the axis, within the width of any shadow. They are lower for low suns, so that their shadows
        // have some of the places in reach.
        const double along = (kBallCentre.z - z) / std::max(sun_.z, 0.25);
        const glm::dvec2 axis = glm::dvec2(kBallCentre) - along * glm::dvec2(sun_);
        const glm::dvec3 place(axis.x + 6 * wide(random), axis.y + 6 * wide(random), z);
        const bool within = isWithin(place, hullAt(boxes, z));
        inHull += within ? 1 : 0;
        if (isInShadow(place, sun_)) {
            ++inShadow;
            ASSERT_TRUE(within) << place.x << " " << place.y << " " << place.z;
            ASSERT_TRUE(reach_.meets({place - 0.01, place + 0.01}));
        }
    }
    ASSERT_GT(inShadow, 500);
    if (sun_.z > 0.3) {
        // The box is around an ellipse that lies askew in it, and around the shadow's upper end.
        EXPECT_LT(inHull, 2.5 * inShadow);
    }
}

TEST_P(ToolReach, BoundsWhatHidesTheSky) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> away(-2, 2);
    const Box box = reach_.closeBy(kLowestSand, kHighestSand);
    for (int i = 0; i < 100'000; ++i) {
        const glm::dvec3 place = kBallCentre + kBallRadius * glm::dvec3(away(random), away(random), away(random));
        if (glm::length(place - kBallCentre) < 1.8 * kBallRadius && place.z > kLowestSand && place.z < kHighestSand) {
            ASSERT_TRUE(isWithin(place, box));
            ASSERT_TRUE(reach_.meets({place, place}));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Suns, ToolReach,
                         testing::Values(glm::dvec3(-0.55, 0.35, 0.6), glm::dvec3(0, 0, 1), glm::dvec3(0.7, 0.7, 0.5),
                                         glm::dvec3(0.2, -0.9, 0.28), glm::dvec3(0.9, -0.4, 0.1)));

}  // namespace
