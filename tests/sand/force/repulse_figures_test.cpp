// SPDX-License-Identifier: Apache-2.0
// The law of Dorjgotov et al. 2007 against figures that were derived by hand.
//
// Most slopes here rise by three in four to the east. Their normal is (-3, 0, 4) / 5. With s = 3t² - 2t³, where t is
// the depth in radii, the push has the direction (1 - s) (-3, 0, 4) / 5 + s (0, 0, 1):
//
//   depth      s       along
//   R / 4      5/32    (-81, 0, 133)
//   R / 2      1/2     (-1, 0, 3)       halfway in angle, as s is a half of two unit vectors
//   3 R / 4    27/32   (-3, 0, 31)
//   R and on   1       (0, 0, 1)
//
// The push is 1000 (e^(d/2) - 1) N, where d is the depth in scene units and R = 0.01.
#include <gtest/gtest.h>

#include "sand/force/law.hpp"
#include "tests/sand/force/force_samples.hpp"

namespace {

using namespace sand::force;
using namespace samples;

constexpr double kThreeInFour = 0.75;
// Heights are rounded to 2^-16 of a cell. The error is at most 8e-9: 3e-6 of a depth of R / 4, and of its force.
constexpr double kRounding = 5e-6;

Response figureOf(const SurfacePatch& patch, Vec3 place) {
    return respond(sand::ForceConstants{}, patch, Contour::sphere(kRadius), place);
}

void expectVec(Vec3 found, Vec3 wanted, double within) {
    EXPECT_NEAR(found.x, wanted.x, within);
    EXPECT_NEAR(found.y, wanted.y, within);
    EXPECT_NEAR(found.z, wanted.z, within);
}

TEST(RepulseOnPaper, TurnsFromTheNormalToTheVerticalAsItSinks) {
    const SurfacePatch slope = slopePatch(kThreeInFour);
    struct Row {
        double depth;  // [radius]
        Vec3 along;
        double newtons;
    };
    for (const auto& [depth, along, newtons] :
         {Row{0.25, {-81, 0, 133}, 1.250782}, Row{0.5, {-1, 0, 3}, 2.503128}, Row{0.75, {-3, 0, 31}, 3.757040},
          Row{1, {0, 0, 1}, 5.012521}, Row{2, {0, 0, 1}, 10.050167}}) {
        SCOPED_TRACE(depth);
        const Response felt = figureOf(slope, placeAt(depth * kRadius));
        expectVec(felt.normal, (1 / norm(along)) * along, kRounding);
        expectVec(felt.push, (newtons / norm(along)) * along, kRounding * newtons + 1e-6);
    }
    const Response over = figureOf(slope, placeAt(-0.1 * kRadius));
    expectVec(over.normal, {-0.6, 0, 0.8}, kRounding);
    EXPECT_EQ(norm(over.push), 0);
}

// At half a radius, the normal is (-1, 0, 3) / √10 and the push is 2.503128 N. Friction is 10 times that, multiplied by
// the part of the velocity along the surface.
TEST(RepulseOnPaper, RubsAlongASlope) {
    const Response felt = figureOf(slopePatch(kThreeInFour), placeAt(0.5 * kRadius));
    const auto friction = [&](Vec3 velocity) { return lawfulForce(felt, velocity) - felt.push; };
    constexpr double kWithin = kRounding * 0.1;
    // Along the surface: (3, 2, 1) · (-1, 0, 3) = 0, so that the whole velocity causes friction.
    expectVec(friction({0.003, 0.002, 0.001}), {-0.0750938, -0.0500626, -0.0250313}, kWithin);
    // Straight down by 0.01: 0.009 of that is along the normal, (0.003, 0, -0.009). The rest is (-0.003, 0, -0.001).
    expectVec(friction({0, 0, -0.01}), {0.0750938, 0, 0.0250313}, kWithin);
    // A velocity along the normal causes no friction.
    expectVec(friction({0.001, 0, -0.003}), {0, 0, 0}, kWithin);
}

TEST(RepulseOnPaper, RubsAcrossTheVerticalAtARadius) {
    const Response felt = figureOf(slopePatch(kThreeInFour), placeAt(kRadius));
    // 10 · 5.012521 · 0.003 N, and no friction against the fall.
    expectVec(lawfulForce(felt, {0.003, 0, -0.004}) - felt.push, {-0.1503756, 0, 0}, kRounding * 0.2);
}

SurfacePatch atTheRim(double slope = 0, double north = kMiddle) {
    sand::HeightField field(kSide, kSide, kCell);
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            field.setHeight(column, row,
                            static_cast<std::int32_t>(std::lround(slope * (column + 0.5) * kCell / field.unit())));
        }
    }
    return {field, probeAt({0, north, 0}), kRadius};
}

// At a depth of one radius, the push is 5.012521 N if the whole ring lies over the field, and its steepness is 501.253
// N per scene unit. At the rim, it is multiplied by the share of the ring's area, 3 π R², that lies over the field.
TEST(RepulseOnPaper, ShrinksWithTheShareOfTheRingOverTheField) {
    constexpr double kWhole = 5.012521, kSteep = 501.253;
    // The ring has 144 equal pieces. A piece counts if its middle lies over the field. An error of 2 of 144 was enough
    // on either side of a chord.
    constexpr double kPieces = 2.0 / 144;
    const SurfacePatch level = atTheRim();
    const Response half = figureOf(level, {0, kMiddle, 0});
    expectVec(half.push, {0, 0, kWhole / 2}, kPieces * kWhole);
    EXPECT_NEAR(half.stiffness, kSteep / 2, kPieces * kSteep);
    // The drag is ten times the push.
    EXPECT_NEAR(half.drag, 10 * half.push.z, 1e-9);
    // The segment beyond a chord at distance R has an area of (4π/3 - √3) R², which is 0.26067 of the ring.
    expectVec(figureOf(level, {kRadius, kMiddle, 0}).push, {0, 0, 0.73933 * kWhole}, kPieces * kWhole);
    expectVec(figureOf(level, {-kRadius, kMiddle, 0}).push, {0, 0, 0.26067 * kWhole}, kPieces * kWhole);
    expectVec(figureOf(atTheRim(0, 0), {0, 0, 0}).push, {0, 0, kWhole / 4}, kPieces * kWhole);
    EXPECT_EQ(norm(figureOf(level, {-2 * kRadius, kMiddle, 0}).push), 0);
}

// Half of the ring lies on a slope. The mean of x over half an annulus is 28/9π R = 0.990297 R, so that the sand is
// 0.742723 R above its height at the rim. A tool whose lowest point is R/2 below that is pushed straight up, by half of
// 2.503128 N.
TEST(RepulseOnPaper, IsVerticalOverTheRim) {
    const Response felt = figureOf(atTheRim(kThreeInFour), {0, kMiddle, 1.242723 * kRadius});
    expectVec(felt.normal, {0, 0, 1}, 0);
    // The mean of x over 144 pieces is 0.991008 R, which is 0.0005 R deeper. Within half a cell of the rim, 2 % of the
    // half ring, sand is as high as in the middle of that cell: 0.0004 R more. Together, this is 0.2 % of a depth of
    // R/2.
    expectVec(felt.push, {0, 0, 2.503128 / 2}, 0.0025 * 2.503128 / 2);
}

/// Returns a patch with `ring` between 0.95 R and 2.1 R, and other heights outside, which the law must not read. The
/// law reads heights up to 0.15 R, or a cell and a half, from its circles. These lie between 1.118 R and 1.936 R.
template <class Height>
SurfacePatch ringPatch(const Height& ring) {
    return patchOf([&](double x, double y) {
        const double r = std::hypot(x, y) / kRadius;
        return r < 0.95 ? -3 * kRadius : r > 2.1 ? (x > 0 ? 4 : -5) * kRadius : ring(x / kRadius, y / kRadius);
    });
}
Contact ringOf(const SurfacePatch& patch) { return measureContact(patch, placeAt(0), Contour::sphere(kRadius)); }

// Heights of 0.2 r²/R, in radii. The mean of r² over the ring is (1/2) (16 - 1)/2 / (3/2) = 2.5 R². Straight lines
// between cells that are 0.1 R apart are higher by 0.1²/3 of the 0.2.
TEST(RepulseOnPaper, MeasuresDepthAgainstTheMeanOfTheRing) {
    const SurfacePatch bowl = ringPatch([](double x, double y) { return 0.2 * kRadius * (x * x + y * y); });
    const Contact contact = ringOf(bowl);
    EXPECT_EQ(contact.share, 1);
    EXPECT_NEAR(contact.depth.value / kRadius, 0.2 * (2.5 + 0.01 / 3), 2e-4);
    EXPECT_NEAR(contact.slopeX.value, 0, 2e-3);
    EXPECT_NEAR(contact.slopeY.value, 0, 2e-3);
    EXPECT_NEAR(contact.depth.slope.z, -1, 1e-12);
}

// Two thirds of the ring lie outside √2 R. Circles are at least 0.08 R away from that step, which is a cell wide. At
// most a twentieth of the two circles beside it is on the step's slope.
TEST(RepulseOnPaper, WeighsTheRingByItsArea) {
    const SurfacePatch step = ringPatch([](double x, double y) { return x * x + y * y > 2 ? 0.3 * kRadius : 0.0; });
    EXPECT_NEAR(ringOf(step).depth.value / kRadius, 0.3 * 2 / 3, 0.3 * 0.02);
}

// Heights of 0.1 x³/R² + 0.2 y, in radii. Least squares over the ring turn x³ into the slope Σx⁴/Σx², which is (3/8) 7
// R⁴ / (1/2) 2.5 R² = 2.1. Six circles of equal area give 2.094. The mean and the depth are 0.
TEST(RepulseOnPaper, TakesItsNormalFromThePlaneThroughTheRing) {
    const SurfacePatch bent = ringPatch([](double x, double y) { return kRadius * (0.1 * x * x * x + 0.2 * y); });
    const Contact contact = ringOf(bent);
    EXPECT_NEAR(contact.slopeX.value, 0.1 * 2.1, 0.1 * 0.015);
    EXPECT_NEAR(contact.slopeY.value, 0.2, 1e-3);
    EXPECT_NEAR(contact.depth.value / kRadius, 0, 1e-3);
}

TEST(ResponseOnPaper, RubsAcrossItsNormalOrLiterallyAsThePaperMayMean) {
    Response felt{{1, 2, 3}, {-0.6, 0, 0.8}, 0.5, 0};
    const Vec3 velocity{1, 2, 3};
    // (1, 2, 3) · (-0.6, 0, 0.8) = 1.8, and (1, 2, 3) - 1.8 (-0.6, 0, 0.8) = (2.08, 2, 1.56).
    expectVec(rubbing(felt, velocity), {2.08, 2, 1.56}, 1e-12);
    expectVec(lawfulForce(felt, velocity), {-0.04, 1, 2.22}, 1e-12);
    felt.direction = sand::FrictionDirection::full;
    expectVec(rubbing(felt, velocity), {1, 2, 3}, 0);
    expectVec(lawfulForce(felt, velocity), {0.5, 1, 1.5}, 0);
    felt.direction = sand::FrictionDirection::vertical;
    expectVec(rubbing(felt, velocity), {0, 0, 3}, 0);
    expectVec(lawfulForce(felt, velocity), {1, 2, 1.5}, 0);
}

TEST(ResponseOnPaper, IsNothingOnLevelSandByItself) {
    const Response nothing;
    expectVec(nothing.push, {0, 0, 0}, 0);
    expectVec(nothing.normal, {0, 0, 1}, 0);
    EXPECT_EQ(nothing.drag, 0);
    EXPECT_EQ(nothing.stiffness, 0);
    EXPECT_EQ(nothing.direction, sand::FrictionDirection::tangential);
}

TEST(ResponseOnPaper, SteepnessIsTheNormOfAllNineDerivatives) {
    // The sums of squares are 1 + 4 + 4, 16 + 16 + 4, and 36. Together they are 81.
    EXPECT_EQ(steepness({0, {1, 2, -2}}, {0, {4, -4, 2}}, {0, {6, 0, 0}}), 9);
    EXPECT_EQ(steepness({5, {}}, {7, {}}, {9, {0, 0, -3}}), 3) << "of the slopes, and not of the values";
}

}  // namespace
