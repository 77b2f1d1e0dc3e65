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
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 0, kCoarsest), 2) << "the light may change by 0.04";
    EXPECT_EQ(ruleOf(1).level(kBox, errors, 0, kCoarsest), 3) << "by 0.08";
    EXPECT_EQ(ruleOf(0.1).level(kBox, errors, 0, kCoarsest), 0) << "by 0.008";
    EXPECT_EQ(ruleOf(3).level(kBox, errors, 0, kCoarsest), 4) << "by 0.24";
    EXPECT_EQ(ruleOf(0.5, 5000).level(kBox, errors, 0, kCoarsest), 2) << "from any distance";
}

TEST(LevelRule, TheErrorOfHeightAloneDecidesWhereLightIsRight) {
    LevelErrors errors;
    errors.height = {0, 0.005F, 0.009F, 0.011F, 0.021F};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 0, kCoarsest), 2) << "half a pixel is 0.01 of a unit";
    EXPECT_EQ(ruleOf(0.5, 25).level(kBox, errors, 0, kCoarsest), 3) << "from twice as far it is 0.02";
    EXPECT_EQ(ruleOf(1).level(kBox, errors, 0, kCoarsest), 3);
    EXPECT_EQ(ruleOf(0.2).level(kBox, errors, 0, kCoarsest), 0);
}

TEST(LevelRule, TheCoarsestLevelWithBothErrorsWithinTheirBoundsIsChosen) {
    LevelErrors errors;
    errors.height = {0, 0, 0, 0, 1};
    errors.light = {0, 0, 0, 1, 0};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 0, kCoarsest), 2);
    errors = {};
    errors.height = {0, 1, 0, 0, 1};
    errors.light = {0, 1, 1, 0, 0};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 0, kCoarsest), 3) << "although finer levels are worse";
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 0, 2), 0);
}

TEST(LevelRule, NoLevelIsCoarserThanAllowed) {
    for (int coarsest = 0; coarsest < kLevels; ++coarsest) {
        EXPECT_EQ(ruleOf(0.5).level(kBox, {}, 0, coarsest), coarsest);
    }
    EXPECT_EQ(ruleOf(0).level(kBox, {}, 0, kCoarsest), 0) << "with a bound of 0 every cell is drawn";
}

/// Returns a rule for a perspective camera that looks along the ground. It is 10 units from the middle of the box, and
/// 9 from the nearest side. Half of the picture's height is one unit at a distance of one unit.
LevelRule fromTheSouth() {
    glm::dmat4 sceneToClip(0);
    sceneToClip[0] = {1, 0, 0, 0};
    sceneToClip[1] = {0, 0, 1, 1};
    sceneToClip[2] = {0, 1, 0, 0};
    sceneToClip[3] = {0, 0, 0, 10};
    return {sceneToClip, {100, 100}, 0.5};
}

TEST(LevelRule, TheNearestPartOfABoxDecides) {
    const LevelRule rule = fromTheSouth();
    LevelErrors errors;
    // At the nearest side, a unit upwards is 50/9 pixels, and half of a pixel is 0.09 of a unit. The rule takes the
    // largest factor of all corners, which may be 11/9 as large, so that the bound is at least 0.0736.
    errors.height = {0, 0.0735F, 0.0901F, 0.0901F, 0.0901F};
    EXPECT_EQ(rule.level(kBox, errors, 0, kCoarsest), 1);
    const Box reachingBehind{{-1, -11, -1}, {1, 1, 1}};
    EXPECT_EQ(rule.level(reachingBehind, errors, 0, kCoarsest), 0) << "the camera is inside";
}

/// Returns a rule for a camera that looks straight down from far away. A cell of side 1 covers `pixels`.
LevelRule fromAbove(double pixels, double pixelsPerQuad = LevelRule::kPixelsPerQuad, double bound = 0.5) {
    glm::dmat4 sceneToClip(1);
    sceneToClip[0] = {std::sqrt(pixels) / 50, 0, 0, 0};
    sceneToClip[1] = {0, std::sqrt(pixels) / 50, 0, 0};
    sceneToClip[2] = {0, 0, -1e-9, 0};
    return {sceneToClip, {100, 100}, bound, pixelsPerQuad};
}

TEST(LevelRule, MovingSandHasQuadsOfAtLeastFourPixels) {
    for (const auto& [pixels, level] : {std::pair{4.01, 0}, {3.99, 1}, {1.01, 1}, {0.99, 2}, {0.251, 2}, {0.01, 4}}) {
        EXPECT_EQ(fromAbove(pixels).levelWhileMoving(kBox, 1, kCoarsest), level) << pixels;
        EXPECT_EQ(fromAbove(4 * pixels).levelWhileMoving(kBox, 0.5, kCoarsest), level) << "of half a cell, " << pixels;
    }
    EXPECT_EQ(fromAbove(0.01).levelWhileMoving(kBox, 1, 2), 2) << "no level is coarser than allowed";
    EXPECT_TRUE(fromAbove(1).coarsensMovement());
    EXPECT_FALSE(fromAbove(1, 0).coarsensMovement());
    EXPECT_FALSE(fromAbove(1, 4, 0).coarsensMovement()) << "every cell is drawn";
}

TEST(LevelRule, NoPointOfThePictureIsFartherFromAVertexThanTheBound) {
    // With a bound of half a pixel, the sides of a quad of the level have at most one pixel.
    for (const auto& [pixels, level] : {std::pair{1.0, 0}, {0.51, 0}, {0.49, 1}, {0.26, 1}, {0.24, 2}, {0.01, 4}}) {
        EXPECT_EQ(fromAbove(pixels * pixels).finest(kBox, 1, kCoarsest), level) << pixels;
        EXPECT_EQ(fromAbove(4 * pixels * pixels).finest(kBox, 0.5, kCoarsest), level) << "of half a cell, " << pixels;
        EXPECT_EQ(fromAbove(pixels * pixels, 4, 1).finest(kBox, 1, kCoarsest), std::min(level + 1, kCoarsest))
            << "of a bound of a pixel, " << pixels;
    }
    EXPECT_EQ(fromAbove(0.0001).finest(kBox, 1, 2), 2) << "no level is coarser than allowed";
    EXPECT_EQ(fromAbove(0.0001, 4, 0).finest(kBox, 1, kCoarsest), 0) << "every cell is drawn";
}

// Seen along the ground, the sides from west to east are long, although a quad covers only few pixels.
TEST(LevelRule, TheLongerSideOfAQuadDecidesWhatThePictureCanShow) {
    const LevelRule rule = fromTheSouth();
    // A unit from west to east is 50/9 pixels at the nearest side. The rule takes the largest factor of all corners, so
    // that it is at most 6.8 pixels: two cells of 0.073 have a pixel.
    EXPECT_EQ(rule.finest(kBox, 0.073, kCoarsest), 1);
    EXPECT_EQ(rule.finest(kBox, 0.075, kCoarsest), 0);
    EXPECT_EQ(rule.levelWhileMoving(kBox, 0.1, kCoarsest), 4) << "a quad covers a hundredth of a pixel";
    const Box reachingBehind{{-1, -11, -1}, {1, 1, 1}};
    EXPECT_EQ(rule.finest(reachingBehind, 1e-9, kCoarsest), 0) << "the camera is inside";
}

TEST(LevelRule, SandThatIsMuchFinerThanAPixelIsNotDrawnFinerThanThePictureShows) {
    LevelErrors errors;
    errors.height = {0, 1, 1, 1, 1};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 0, kCoarsest), 0);
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 3, kCoarsest), 3);
    errors.height = {};
    EXPECT_EQ(ruleOf(0.5).level(kBox, errors, 3, kCoarsest), 4) << "even sand may be drawn more coarsely";
}

TEST(LevelRule, SandAroundTheEyeIsMeasuredAlthoughItMoves) {
    const LevelRule rule = fromTheSouth();
    EXPECT_NE(rule.levelWhileMoving(kBox, 1, kCoarsest), std::nullopt);
    const Box reachingBehind{{-1, -11, -1}, {1, 1, 1}};
    EXPECT_EQ(rule.levelWhileMoving(reachingBehind, 1, kCoarsest), std::nullopt);
}

// The camera of above is 10 units from the middle of the box, and looks along its ground. A level quad at height h,
// y units away, is h / y^3 * 50 * 50 pixels large. The corner at height 1 that is 9 units away decides: 3.43 pixels.
TEST(LevelRule, TheLargestQuadOfMovingSandDecides) {
    const LevelRule rule = fromTheSouth();
    EXPECT_EQ(rule.levelWhileMoving(kBox, 1, kCoarsest), 1);
    EXPECT_EQ(rule.levelWhileMoving(kBox, 1.09, kCoarsest), 0);
    EXPECT_EQ(rule.levelWhileMoving(kBox, 1.07, kCoarsest), 1);
    EXPECT_EQ(rule.levelWhileMoving({{-1, -1, -0.1}, {1, 1, 0.1}}, 1, kCoarsest), 2);
}

}  // namespace
}  // namespace level_rules
