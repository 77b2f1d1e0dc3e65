// SPDX-License-Identifier: Apache-2.0
// The law of Purchart et al. 2012, against figures derived by hand.
#include <gtest/gtest.h>

#include "sand/force/interpolation.hpp"
#include "sand/force/law.hpp"
#include "tests/sand/force/force_samples.hpp"

namespace {

using namespace sand::force;
using namespace samples;

constexpr double kUnit = 2;  // [scene unit]: of the field of Dorjgotov et al. 2007

sand::ForceConstants paper(bool literal = false) {
    sand::ForceConstants constants;
    constants.law = sand::ForceLaw::controlPoints;
    constants.unitLength = kUnit;
    constants.literal = literal;
    return constants;
}

Response felt(const SurfacePatch& patch, Vec3 place, const sand::ForceConstants& constants) {
    return respond(constants, patch, Contour::sphere(kRadius), place);
}

TEST(ControlPoints, PushUpByTheirMeanDepth) {
    for (const bool literal : {false, true}) {
        // dh = 0.01 / 2 at all points: 0.005 · 10 N upwards, and the sides balance.
        const Response response = felt(levelPatch(), placeAt(kRadius), paper(literal));
        EXPECT_NEAR(response.push.z, 0.05, 1e-7);
        EXPECT_NEAR(norm({response.push.x, response.push.y, 0}), 0, 1e-9);
        EXPECT_NEAR(response.stiffness, 10 / kUnit, 1e-6);
    }
}

TEST(ControlPoints, PushAwayFromTheSideWhereSandIsHigher) {
    // dh_i = (d + g R cos a) / 2, so that the mean of dh_i cos a is g R / 4: 10 · 0.5 · 0.01 / 4 N.
    const Response response = felt(slopePatch(0.5), placeAt(2 * kRadius), paper());
    EXPECT_NEAR(response.push.x, -0.0125, 1e-5);
    EXPECT_NEAR(response.push.y, 0, 1e-7);
    EXPECT_NEAR(response.push.z, 0.1, 1e-5);
}

TEST(ControlPoints, FeelAGelThatIsAcrossOnly) {
    // The tool moves 0.002 / 2 of the field per frame: 0.01 N against that motion, and no force against falling.
    const Response response = felt(levelPatch(), placeAt(kRadius), paper());
    const Vec3 friction = lawfulForce(response, {0.002, 0, -0.3}) - response.push;
    EXPECT_NEAR(friction.x, -0.01, 1e-9);
    EXPECT_NEAR(norm({0, friction.y, friction.z}), 0, 1e-12);
    EXPECT_EQ(felt(levelPatch(), placeAt(-kRadius), paper()).drag, 0) << "none in the air";
}

TEST(ControlPoints, RubByMaterialAndSpeedWhereAskedTo) {
    sand::ForceConstants constants = paper();
    constants.frictionCoefficient = 0.6;
    constants.frictionSpeed = 0.3;
    const Response response = felt(levelPatch(), placeAt(kRadius), constants);
    // At 0.3 scene units per second: Coulomb's 0.6 · 0.05 N, and the gel's 0.005 / 2 · 10 N.
    EXPECT_NEAR(lawfulForce(response, {0.3 / 60, 0, 0}).x, -0.03 - 0.025, 1e-6);
    EXPECT_NEAR(lawfulForce(response, {0.6 / 60, 0, 0}).x, -0.06 - 0.05, 1e-6) << "a higher velocity, a larger force";
}

TEST(ControlPoints, LiterallyPullDownAndJumpByTheTolerance) {
    const double reach = 1e-3 * kUnit;  // z_tol [scene unit]
    const Response over = felt(levelPatch(), placeAt(-reach * 0.999), paper(true));
    EXPECT_NEAR(over.push.z, -0.01, 2e-5) << "-z_tol F_M";
    EXPECT_NEAR(over.drag, 10 / kUnit, 1e-9) << "the gel effect is complete at once";
    const Response beyond = felt(levelPatch(), placeAt(-reach * 1.001), paper(true));
    EXPECT_EQ(beyond.push.z, 0);
    EXPECT_EQ(beyond.drag, 0);
}

TEST(ControlPoints, OtherwiseGrowFromNothingIntoTheLiteralForce) {
    const double reach = 1e-3 * kUnit;
    const SurfacePatch level = levelPatch();
    EXPECT_EQ(felt(level, placeAt(0), paper()).push.z, 0);
    EXPECT_EQ(felt(level, placeAt(-reach / 2), paper()).push.z, 0);
    // The push is t² (2 - t) of z_tol F_M = 0.01 N: 7/64, 3/8 and 45/64 of it. Its slope is t (4 - 3 t): 13/16, 5/4 and
    // 21/16 of F_M per unit length. Places are doubles near 1 with errors of 2e-16, which change a force by less than
    // 1e-12.
    struct Row {
        double part, newtons, rate;  // part of z_tol; push; slope as a share of F_M
    };
    for (const auto& [part, newtons, rate] :
         {Row{0.25, 0.00109375, 0.8125}, Row{0.5, 0.00375, 1.25}, Row{0.75, 0.00703125, 1.3125}}) {
        const Response here = felt(level, placeAt(part * reach), paper());
        EXPECT_NEAR(here.push.z, newtons, 1e-12) << part;
        EXPECT_NEAR(here.stiffness, rate * 10 / kUnit, 1e-9 * rate * 10 / kUnit) << part;
    }
    double last = 0;
    for (int i = 1; i <= 200; ++i) {
        const double depth = reach * i / 100;
        const double now = felt(level, placeAt(depth), paper()).push.z;
        EXPECT_GE(now, last);
        EXPECT_LE(now - last, 10 / kUnit * reach / 100 * 4 / 3 + 1e-9) << "at most four thirds as stiff";
        last = now;
        if (i >= 100) {
            EXPECT_NEAR(now, felt(level, placeAt(depth), paper(true)).push.z, 1e-9);
        }
    }
}

TEST(ControlPoints, BesideTheFieldAreOutOfTouch) {
    const SurfacePatch level = levelPatch();
    const double whole = felt(level, {kMiddle, kMiddle, 0}, paper()).push.z;
    const SurfacePatch rim(sand::HeightField(kSide, kSide, kCell), probeAt({0, kMiddle, 0}), kRadius);
    EXPECT_NEAR(felt(rim, {0, kMiddle, 0}, paper()).push.z, whole / 2, whole / 16);
    EXPECT_EQ(norm(felt(rim, {-0.5, kMiddle, -1}, paper()).push), 0);
}

// Equation 9 at 60 and 1000 a second, the rates of both papers: 16 or 17 haptic frames between two surfaces.
TEST(Interpolation, ArrivesAfterAsManyFramesAsTheLastSurfaceLasted) {
    Interpolation equation9;
    const auto at = [&](bool replaced, bool literal, double force) {
        return equation9.at(replaced, false, literal, {{0, 0, force}, {0, 0, 1}, 2 * force}).push.z;
    };
    (void)equation9.at(true, true, true, {{0, 0, 1}, {0, 0, 1}, 2});
    for (int it = 1; it < 17; ++it) {
        EXPECT_EQ(at(false, true, 9), 1) << "only one force is known";
    }
    for (int it = 1; it <= 16; ++it) {
        EXPECT_NEAR(at(it == 1, true, 2), 1 + it / 17.0, 1e-12) << "itp is 17";
    }
    EXPECT_NEAR(at(true, true, 4), 2 + 2 / 16.0, 1e-12)
        << "as printed: begins at F, which was not reached; itp is now 16";
    for (int it = 2; it <= 20; ++it) {
        EXPECT_NEAR(at(false, true, 0), 2 + 2 * std::min(it / 16.0, 1.0), 1e-12);
    }
    EXPECT_NEAR(at(true, false, 8), 4 + 4 / 20.0, 1e-12);
    EXPECT_NEAR(at(false, false, 8), 4 + 8 / 20.0, 1e-12);
    EXPECT_NEAR(at(true, false, 0), (4 + 8 / 20.0) / 2, 1e-12)
        << "otherwise begins at the force that was sent last; itp is 2";
    EXPECT_EQ(at(true, true, 3), 3) << "with a surface every frame, there is nothing to interpolate";
}

}  // namespace
