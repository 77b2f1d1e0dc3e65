// SPDX-License-Identifier: Apache-2.0
#include "sand/force/finite_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/input_error.hpp"
#include "sand/model/rules.hpp"
#include "scene/model/material.hpp"

namespace {

using sand::ForceConstants;
using sand::ForceLaw;
using namespace sand::force;

constexpr double kLargest = std::numeric_limits<double>::max();
const double kRoot = std::sqrt(kLargest);  // the square of a larger number is not finite

LawRegion fieldOf(double side) { return LawRegion::of(512, side / 512); }

ForceConstants purchart(double side) {
    ForceConstants constants;
    constants.law = ForceLaw::controlPoints;
    constants.unitLength = side;
    return constants;
}

/// Expects that `constants` are refused for `key`, that the named bound is allowed, and that a percent beyond is not.
void expectBound(ForceConstants constants, double ForceConstants::*key, bool atMost, const LawRegion& region) {
    const auto fault = faultOf(constants, region);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->key->constant, key) << fault->key->name;
    EXPECT_EQ(fault->value, constants.*key);
    EXPECT_EQ(fault->atMost, atMost);
    ASSERT_TRUE(fault->allowed);
    constants.*key = *fault->allowed;
    EXPECT_FALSE(faultOf(constants, region)) << *fault->allowed;
    constants.*key *= atMost ? 1.01 : 1 / 1.01;
    EXPECT_TRUE(faultOf(constants, region)) << *fault->allowed;
}

TEST(FiniteLaw, LetsEveryConstantButTheExponentReachItsBoundOnAFieldOfUsualSize) {
    const LawRegion region = fieldOf(2);
    ForceConstants dorjgotov;
    EXPECT_FALSE(faultOf(dorjgotov, region));
    dorjgotov.stiffness = dorjgotov.friction = 1e9;
    dorjgotov.frictionArea = 1e6;
    EXPECT_FALSE(faultOf(dorjgotov, region)) << "a drag of 1e24 (e - 1)";
    ForceConstants points = purchart(2);
    EXPECT_FALSE(faultOf(points, region));
    points.maxForce = 1e6;
    points.frictionCoefficient = 1e3;
    points.frictionSpeed = 1e-9;
    EXPECT_FALSE(faultOf(points, region)) << "a drag of 6e19";
    points.unitLength = kLargest;
    EXPECT_FALSE(faultOf(points, region));
    points.unitLength = 2;
    points.depthExponent = 1e6;
    EXPECT_FALSE(faultOf(points, region)) << "a constant of the law that was not chosen";
}

TEST(FiniteLaw, NamesTheLargestExponent) {
    // On the steepest sand, the force k_s e^(k_c d) changes by k_c and 8192 in two directions times itself per unit.
    // The square of that must be finite: 2 k_c = ln(kRoot / (1000 k_c 8192 sqrt(2))), for which k_c = 166.7.
    const double steep = std::log(kRoot / (1000 * 166.7 * 8192 * std::sqrt(2))) / 2;
    ASSERT_NEAR(steep, 166.7, 0.1);
    ForceConstants constants;
    constants.depthExponent = 20000;
    auto fault = faultOf(constants, fieldOf(2));
    ASSERT_TRUE(fault);
    EXPECT_STREQ(fault->key->name, "depth_exponent");
    EXPECT_EQ(fault->depth, 2) << "the field's longer side";
    EXPECT_EQ(fault->allowed, 166);

    // Twice the friction k_s k_f k_a e^(k_c d) at 20 m/s. An arm whose reach is 5 mm covers 2 units: 2 / 0.005 / 3 per
    // frame.
    constants.stiffness = constants.friction = 1e9;
    constants.frictionArea = 1e6;
    fault = faultOf(constants, fieldOf(2));
    ASSERT_TRUE(fault);
    const double rubbed = std::log(kRoot / (2 * 1e24 * (2 / 0.005 / 3))) / 2;
    EXPECT_EQ(fault->allowed, std::floor(rubbed)) << rubbed;
}

TEST(FiniteLaw, NamesABoundForEachConstantAtItsExtreme) {
    ForceConstants constants;
    constants.depthExponent = 1e6;
    for (const double side : {1e-3, 2.0, 1e4}) {
        expectBound(constants, &ForceConstants::depthExponent, true, fieldOf(side));
    }
    constants = purchart(2);
    for (const double length : {std::numeric_limits<double>::min(), 1e-300, 1e-160}) {
        constants.unitLength = length;
        expectBound(constants, &ForceConstants::unitLength, false, fieldOf(2));
    }
    constants.maxForce = 1e6;
    constants.frictionCoefficient = 1e3;
    constants.frictionSpeed = 1e-9;
    expectBound(constants, &ForceConstants::unitLength, false, fieldOf(2));
    // Only on a field beyond all use can friction overflow by itself.
    constants.unitLength = 1e140;
    expectBound(constants, &ForceConstants::frictionCoefficient, true, fieldOf(1e140));
}

TEST(FiniteLaw, LowersTheDefaultExponentOnALargeFieldAlone) {
    for (const double side : {1e-3, 2.0, 600.0}) {
        EXPECT_EQ(usualDepthExponent({}, fieldOf(side)), 0.5) << side;
    }
    for (const double side : {700.0, 15e3, 1e100}) {
        ForceConstants constants;
        constants.depthExponent = usualDepthExponent({}, fieldOf(side));
        EXPECT_LT(constants.depthExponent, 0.5);
        EXPECT_GT(constants.depthExponent, 0);
        EXPECT_FALSE(faultOf(constants, fieldOf(side))) << side;
        constants.depthExponent *= 1.01;
        EXPECT_TRUE(faultOf(constants, fieldOf(side))) << side << ": not the largest";
    }
    EXPECT_EQ(usualDepthExponent(purchart(15e3), fieldOf(15e3)), 0.5) << "a law without this constant";
    for (const double side : {1e308, 1e-307}) {
        EXPECT_FALSE(faultOf({.depthExponent = usualDepthExponent({}, fieldOf(side))}, fieldOf(side))) << side;
    }
}

TEST(FiniteLaw, HoldsForEveryRadiusThatAnOperatorCanChoose) {
    const scene::MaterialGrid grid{sand::Scheme::isotropic, 60, 0.25, 512};
    const LawRegion region = LawRegion::of(grid.longerSide, grid.cellSize);
    EXPECT_EQ(region.deepest, 128);
    const auto accepts = [&](double radius) {
        try {
            return scene::withTool({}, {.radius = radius}, grid).toolRadius == radius;
        } catch (const base::InputError&) {
            return false;
        }
    };
    EXPECT_TRUE(accepts(region.smallestRadius) && accepts(region.largestRadius));
    EXPECT_FALSE(accepts(region.smallestRadius / 1.001) || accepts(region.largestRadius * 1.001));
}

}  // namespace
