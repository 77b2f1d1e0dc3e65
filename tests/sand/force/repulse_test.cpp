// SPDX-License-Identifier: Apache-2.0
// The law of Dorjgotov et al. 2007 on sand that lies still.
#include <gtest/gtest.h>

#include "sand/force/law.hpp"
#include "tests/sand/force/force_samples.hpp"

namespace {

using namespace sand::force;
using namespace samples;
using sand::ForceConstants;
using sand::FrictionDirection;

Response pushed(const SurfacePatch& patch, Vec3 place, const ForceConstants& constants = {}) {
    return respond(constants, patch, Contour::sphere(kRadius), place);
}

double pushAt(double depth) { return norm(pushed(levelPatch(), placeAt(depth)).push); }

TEST(Repulse, IsThePapersAtOneRadius) {
    // 1000 (e^{0.005} − 1) = 5.0125 N.
    EXPECT_NEAR(pushAt(kRadius), 5.0125, 1e-3);
    const double slope = (pushAt(kRadius + 1e-5) - pushAt(kRadius - 1e-5)) / 2e-5;
    EXPECT_NEAR(slope, 500 * std::exp(0.005), 0.5);
    EXPECT_NEAR(pushed(levelPatch(), placeAt(kRadius)).stiffness, 500 * std::exp(0.005), 1e-3);
}

TEST(Repulse, IsNothingOverTheSandAndGrowsFromNothing) {
    EXPECT_EQ(pushAt(0), 0);
    EXPECT_EQ(pushAt(-0.001), 0);
    EXPECT_EQ(pushAt(-10), 0);
    EXPECT_LT(pushAt(1e-6), 1e-3);
    EXPECT_GT(pushAt(1e-6), 0);
}

TEST(Repulse, IsNothingBesideTheField) {
    EXPECT_EQ(norm(pushed(levelPatch(), {-0.5, kMiddle, -1}).push), 0);
    EXPECT_EQ(norm(pushed(SurfacePatch{}, placeAt(kRadius)).push), 0);
    EXPECT_EQ(norm(respond({}, levelPatch(), Contour{}, placeAt(kRadius)).push), 0) << "no tool";
}

TEST(Repulse, TurnsFromTheSurfacesNormalToTheVertical) {
    constexpr double kSlope = 0.5;
    const SurfacePatch slope = slopePatch(kSlope);
    const auto normalAt = [&](double depth) { return pushed(slope, placeAt(depth)).normal; };
    const double flat = 1 / std::sqrt(1 + kSlope * kSlope);
    EXPECT_NEAR(normalAt(-1e-4).x, -kSlope * flat, 1e-3);
    EXPECT_NEAR(normalAt(-1e-4).z, flat, 1e-3);
    EXPECT_NEAR(normalAt(0).y, 0, 1e-3);
    EXPECT_NEAR(normalAt(kRadius).z, 1, 1e-3);
    const Vec3 between = normalAt(kRadius / 2);
    EXPECT_GT(between.z, flat);
    EXPECT_LT(between.z, 1);
}

TEST(Repulse, RubsAgainstTheTangentialVelocityOnly) {
    const Response response = pushed(levelPatch(), placeAt(kRadius));
    const double push = norm(response.push);
    const Vec3 force = lawfulForce(response, {0.002, 0, -0.5});
    EXPECT_NEAR(force.x, -10 * 0.002 * push, 1e-9);
    EXPECT_NEAR(force.y, 0, 1e-9);
    EXPECT_NEAR(force.z, push, 1e-9);
}

TEST(Repulse, RubsWithItsAreaAndLiterallyInAnyDirectionThePaperMayMean) {
    ForceConstants constants;
    constants.frictionArea = 3;
    const SurfacePatch level = levelPatch();
    const Vec3 place = placeAt(kRadius), velocity{0.002, 0, -0.004};
    EXPECT_NEAR(lawfulForce(pushed(level, place, constants), velocity).x, -3 * 10 * 0.002 * pushAt(kRadius), 1e-9);

    const auto frictionOf = [&](FrictionDirection direction, bool literal) {
        constants = {};
        constants.frictionDirection = direction;
        constants.literal = literal;
        const Response response = pushed(level, place, constants);
        return (1 / (10 * norm(response.push))) * (lawfulForce(response, velocity) - response.push);
    };
    const Vec3 full = frictionOf(FrictionDirection::full, true);
    EXPECT_NEAR(full.x, -velocity.x, 1e-12);
    EXPECT_NEAR(full.z, -velocity.z, 1e-12);
    const Vec3 vertical = frictionOf(FrictionDirection::vertical, true);
    EXPECT_NEAR(vertical.x, 0, 1e-12);
    EXPECT_NEAR(vertical.z, -velocity.z, 1e-12);
    EXPECT_NEAR(frictionOf(FrictionDirection::vertical, false).x, -velocity.x, 1e-12) << "literal was not asked for";
}

TEST(Repulse, MeasuresAnyToolOutsideItsOutline) {
    // A trench as broad as the tool, as the tool has dug it. The ring lies on the sand beside it.
    Contour ellipse = Contour::sphere(kRadius);
    for (Vec3& point : ellipse.points) {
        point = {point.x, 0.5 * point.y, -0.3 * kRadius};
    }
    ellipse.lowest = -0.3 * kRadius;
    const SurfacePatch trench =
        patchOf([](double x, double y) { return std::hypot(x, y) < 0.95 * kRadius ? -kRadius : 0.0; });
    const Contact contact = measureContact(trench, placeAt(kRadius), ellipse);
    EXPECT_NEAR(contact.depth.value, 0.3 * kRadius, 1e-6) << "its own lowest point under the sand beside it";
}

// Compares the derivatives with differences of the law itself. The guards and the local model depend on them.
TEST(Repulse, KnowsItsJacobianOnRoughSand) {
    constexpr double kStep = 1e-7;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const SurfacePatch rough = roughPatch(seed);
        const Vec3 place = placeAt(0.6 * kRadius, 1e-5 * seed, 3e-5);
        double square = 0;
        for (const Vec3 step : {Vec3{kStep, 0, 0}, Vec3{0, kStep, 0}, Vec3{0, 0, kStep}}) {
            const Vec3 change = pushed(rough, place + step).push - pushed(rough, place - step).push;
            square += dot(change, change) / (4 * kStep * kStep);
        }
        const Response response = pushed(rough, place);
        ASSERT_GT(norm(response.push), 0) << "seed " << seed;
        EXPECT_NEAR(response.stiffness, std::sqrt(square), 2e-3 * response.stiffness) << "seed " << seed;
    }
}

}  // namespace
