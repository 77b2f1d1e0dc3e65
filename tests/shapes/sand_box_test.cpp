// SPDX-License-Identifier: Apache-2.0
#include "shapes/sand_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "shapes/box_outline.hpp"
#include "tests/support/seed.hpp"

namespace shapes {
namespace {

/// Returns the edge of a field whose ground at its rim has these heights, three on each side.
SandRim rimOf(glm::vec2 field, const std::vector<float>& heights) {
    SandRim rim{field, {{}}, false};
    const glm::vec2 middle = field / 2.0F;
    const std::vector<glm::vec2> places{{0, 0}, {middle.x, 0},       {field.x, 0}, {field.x, middle.y},
                                        field,  {middle.x, field.y}, {0, field.y}, {0, middle.y}};
    for (std::size_t i = 0; i < places.size(); ++i) {
        rim.cuts[0].emplace_back(places[i], heights[i]);
    }
    return rim;
}

TEST(SandBox, IsWithinTheOutlineThatViewsFrame) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    for (int i = 0; i < 200; ++i) {
        const glm::vec2 field(between(0.1F, 10), between(0.1F, 10));
        std::vector<float> heights(8);
        std::ranges::generate(heights, [&] { return between(-1, i % 2 == 0 ? -0.99F : 3); });
        const auto [lowest, highest] = std::ranges::minmax(heights);
        const sand::Rim rim = i % 3 == 0 ? sand::Rim::open : sand::Rim::closed;
        const SandBox box(rimOf(field, heights), lowest, 0.01, rim);
        const Box outline = boxOutline(field, double{lowest}, double{highest});
        Box drawn{glm::dvec3(1e9), glm::dvec3(-1e9)};
        for (const auto* triangles : {&box.boards(), &box.sides()}) {
            for (const SolidVertex& vertex : *triangles) {
                drawn = around(drawn, {glm::dvec3(vertex.position), glm::dvec3(vertex.position)});
            }
        }
        constexpr double kRounding = 1e-5;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(drawn.low[axis], outline.low[axis] - kRounding);
            EXPECT_LE(drawn.high[axis], outline.high[axis] + kRounding);
            EXPECT_NEAR(drawn.low[axis], outline.low[axis], kRounding) << "the floor and its edges are the outline";
        }
    }
}

}  // namespace
}  // namespace shapes
