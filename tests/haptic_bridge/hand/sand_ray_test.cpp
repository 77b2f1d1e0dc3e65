// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/sand_ray.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace haptic_bridge {
namespace {

constexpr double kExact = 0.005;  // a hundredth of a step, which is 0.5, as seen from above

SandBody level(double height) {
    return {100, 60, height, height, 0.5, [height](double, double) { return height; }};
}

void expectMeets(const Ray& ray, const SandBody& sand, double x, double y) {
    const auto met = meetSand(ray, sand);
    ASSERT_TRUE(met.has_value());
    EXPECT_NEAR(met->x, x, kExact);
    EXPECT_NEAR(met->y, y, kExact);
}

TEST(SandRay, MeetsLevelSandWhereThePlaneIs) {
    // From (50, -20, 40), 1 unit down per 1 unit north: 30 units down to height 10.
    expectMeets({{50, -20, 40}, {0, 1, -1}}, level(10), 50, 10);
    expectMeets({{50, -20, 40}, {0, 7, -7}}, level(10), 50, 10);
    expectMeets({{20, 30, 40}, {0, 0, -1}}, level(10), 20, 30);
}

TEST(SandRay, MeetsLevelSandOfAnyHeightExactly) {
    // The places are not at multiples of a step, as those of the other tests are. The sand has room below, because the
    // end of the ray in its box is rounded.
    for (double height = 5; height < 15; height += 0.37) {
        SandBody sand = level(height);
        sand.lowest -= 1;
        expectMeets({{50, -20, 40}, {0, 1, -1}}, sand, 50, 20 - height);
    }
}

TEST(SandRay, MeetsTheSandAtItsEdges) {
    for (const auto& [x, y] : {std::pair(20.0, 0.0), {20, 60}, {0, 30}, {100, 30}}) {
        expectMeets({{x, y, 40}, {0, 0, -1}}, level(10), x, y);
    }
}

TEST(SandRay, MeetsARidgeBeforeTheSandBehindIt) {
    // A ridge 8 high at y = 30 hides level sand behind it. Its southern slope rises by 1 per unit from y = 22.
    const auto ridge = [](double, double y) { return std::max(0.0, 8 - std::abs(y - 30)); };
    const SandBody sand{100, 60, 0, 8, 0.5, ridge};
    // The ray falls by 1 per 4 units: height 12 - t/4 at y = t. It meets y - 22 = 12 - y / 4 at y = 27.2.
    expectMeets({{50, 0, 12}, {0, 4, -1}}, sand, 50, 27.2);
    // A higher ray passes over the ridge: it is 8.5 high there, and 0 high at y = 56.
    expectMeets({{50, 0, 18.3}, {0, 3.06, -1}}, sand, 50, 56.0);
}

TEST(SandRay, PassesBesideTheSandAndAboveIt) {
    EXPECT_FALSE(meetSand({{50, -20, 40}, {0, 1, -3}}, level(10)).has_value()) << "it falls south of the field";
    EXPECT_FALSE(meetSand({{50, -20, 40}, {0, 1, 0.1}}, level(10)).has_value()) << "it rises";
    EXPECT_FALSE(meetSand({{-5, 30, 40}, {0, 0, -1}}, level(10)).has_value()) << "it falls west of the field";
    EXPECT_FALSE(meetSand({{50, -20, 40}, {0, -1, -1}}, level(10)).has_value()) << "the sand is behind the eye";
}

TEST(SandRay, IgnoresTheSidesOfTheSandFromOutside) {
    // The ray enters the box of all heights, from 0 to 10, below the surface.
    const SandBody sand{100, 60, 0, 10, 0.5, [](double, double) { return 10.0; }};
    EXPECT_FALSE(meetSand({{50, -20, 5}, {0, 1, 0}}, sand).has_value());
    EXPECT_FALSE(meetSand({{50, 30, -20}, {0, 0, 1}}, sand).has_value()) << "from below";
    expectMeets({{50, -20, 16}, {0, 4, -1}}, sand, 50, 4);
}

}  // namespace
}  // namespace haptic_bridge
