// SPDX-License-Identifier: Apache-2.0
#include "render_node/surface/level_rule.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace level_rules {
namespace {

using render_node::LevelErrors;
using render_node::LevelRule;
using shapes::Box;
using shapes::kLevels;

constexpr Box kBox{{-1, -1, -1}, {1, 1, 1}};
constexpr int kCoarsest = kLevels - 1;

/// Returns a rule for a camera that looks along the ground. A scene unit upwards moves a point of the box up by
/// `pixels` pixels, wherever the point is.
LevelRule ruleOf(double bound, double pixels = 50) {
    glm::dmat4 sceneToClip(1);
    sceneToClip[1] = {0, 0, 1, 0};  // north goes into depth
    sceneToClip[2] = {0, pixels / 50, 0, 0};
    return {sceneToClip, {200, 100}, bound};  // the picture is two units high in clip coordinates
}

TEST(LevelRule, TheErrorOfLightAloneDecidesWhereHeightsAreRight) {
    LevelErrors errors;
    errors.light = {0, 0.01F, 0.03F, 0.05F, 0.2F};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, kCoarsest), 2) << "the light may change by 0.04";
    EXPECT_EQ(ruleOf(1).level(kBox, errors, kCoarsest), 3) << "by 0.08";
    EXPECT_EQ(ruleOf(0.1).level(kBox, errors, kCoarsest), 0) << "by 0.008";
    EXPECT_EQ(ruleOf(3).level(kBox, errors, kCoarsest), 4) << "by 0.24";
    EXPECT_EQ(ruleOf(0.5, 5000).level(kBox, errors, kCoarsest), 2) << "from any distance";
}

TEST(LevelRule, TheErrorOfHeightAloneDecidesWhereLightIsRight) {
    LevelErrors errors;
    errors.height = {0, 0.005F, 0.009F, 0.011F, 0.021F};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, kCoarsest), 2) << "half a pixel is 0.01 of a unit";
    EXPECT_EQ(ruleOf(0.5, 25).level(kBox, errors, kCoarsest), 3) << "from twice as far it is 0.02";
    EXPECT_EQ(ruleOf(1).level(kBox, errors, kCoarsest), 3);
    EXPECT_EQ(ruleOf(0.2).level(kBox, errors, kCoarsest), 0);
}

TEST(LevelRule, TheCoarsestLevelWithBothErrorsWithinTheirBoundsIsChosen) {
    LevelErrors errors;
    errors.height = {0, 0, 0, 0, 1};
    errors.light = {0, 0, 0, 1, 0};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, kCoarsest), 2);
    errors = {};
    errors.height = {0, 1, 0, 0, 1};
    errors.light = {0, 1, 1, 0, 0};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, kCoarsest), 3) << "although finer levels are worse";
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 2), 0);
}

TEST(LevelRule, NoLevelIsCoarserThanAllowed) {
    for (int coarsest = 0; coarsest < kLevels; ++coarsest) {
        EXPECT_EQ(ruleOf(0.5).level(kBox, {}, coarsest), coarsest);
    }
    EXPECT_EQ(ruleOf(0).level(kBox, {}, kCoarsest), 0) << "with a bound of 0 every cell is drawn";
}

// A perspective camera looks along the ground. It is 10 units from the middle of the box, and 9 from the nearest side.
// Half of the picture's height is one unit at a distance of one unit.
TEST(LevelRule, TheNearestPartOfABoxDecides) {
    glm::dmat4 sceneToClip(0);
    sceneToClip[0] = {1, 0, 0, 0};
    sceneToClip[1] = {0, 0, 1, 1};
    sceneToClip[2] = {0, 1, 0, 0};
    sceneToClip[3] = {0, 0, 0, 10};
    const LevelRule rule(sceneToClip, {100, 100}, 0.5);
    LevelErrors errors;
    // At the nearest side, a unit upwards is 50/9 pixels, and half of a pixel is 0.09 of a unit. The rule takes the
    // largest factor of all corners, which may be 11/9 as large, so that the bound is at least 0.0736.
    errors.height = {0, 0.0735F, 0.0901F, 0.0901F, 0.0901F};
    EXPECT_EQ(rule.level(kBox, errors, kCoarsest), 1);
    const Box reachingBehind{{-1, -11, -1}, {1, 1, 1}};
    EXPECT_EQ(rule.level(reachingBehind, errors, kCoarsest), 0) << "the camera is inside";
}

}  // namespace
}  // namespace level_rules
