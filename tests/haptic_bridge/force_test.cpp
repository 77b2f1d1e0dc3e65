// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptic_bridge/devices/hand_settings.hpp"
#include "haptic_bridge/hand_mapping.hpp"
#include "sand/force/contact_force.hpp"
#include "sand/terrain.hpp"

namespace {

using namespace sand::force;

constexpr double kRadius = 0.01;  // the first paper's, in a field of two units

sand::ProbePoint probeAt(double x, double y, double cell) {
    return {static_cast<std::int32_t>(x / cell * sand::kProbePerCell),
            static_cast<std::int32_t>(y / cell * sand::kProbePerCell), 0};
}

/// Level sand at height 0, or a slope to the east.
SurfacePatch patchOf(double slope = 0) {
    sand::HeightField field(512, 512, 2.0 / 512);
    for (int row = 0; row < 512; ++row) {
        for (int column = 0; column < 512; ++column) {
            field.setHeight(column, row, static_cast<std::int32_t>(slope * (column - 255.5) * sand::kUnitsPerCell));
        }
    }
    return {field, probeAt(1, 1, field.cellSize()), kRadius};
}

double pushAt(double depth) {
    const Contact contact = measureContact(patchOf(), {1, 1, kRadius - depth}, kRadius);
    return norm(contactForce({}, contact, {}));
}

TEST(ContactForce, IsThePapersAtOneRadius) {
    // 1000 (e^{0.005} − 1) = 5.0125 N.
    EXPECT_NEAR(pushAt(kRadius), 5.0125, 1e-3);
    const double slope = (pushAt(kRadius + 1e-5) - pushAt(kRadius - 1e-5)) / 2e-5;
    EXPECT_NEAR(slope, 500 * std::exp(0.005), 0.5);
}

TEST(ContactForce, IsNothingOverTheSandAndGrowsFromNothing) {
    EXPECT_EQ(pushAt(0), 0);
    EXPECT_EQ(pushAt(-0.001), 0);
    EXPECT_EQ(pushAt(-10), 0);
    EXPECT_LT(pushAt(1e-6), 1e-3);
}

TEST(ContactForce, IsNothingBesideTheField) {
    const Contact contact = measureContact(patchOf(), {-0.5, 1, -1}, kRadius);
    EXPECT_EQ(contact.share, 0);
    EXPECT_EQ(norm(contactForce({}, contact, {})), 0);
    EXPECT_EQ(norm(contactForce({}, measureContact(SurfacePatch{}, {1, 1, 0}, kRadius), {})), 0);
}

TEST(ContactForce, TurnsFromTheSurfacesNormalToTheVertical) {
    constexpr double kSlope = 0.5;
    const auto normalAt = [&](double depth) {
        return measureContact(patchOf(kSlope), {1, 1, kRadius - depth}, kRadius).normal;
    };
    const double flat = 1 / std::sqrt(1 + kSlope * kSlope);
    EXPECT_NEAR(normalAt(-1e-4).x, -kSlope * flat, 1e-3);
    EXPECT_NEAR(normalAt(-1e-4).z, flat, 1e-3);
    EXPECT_NEAR(normalAt(0).y, 0, 1e-3);
    EXPECT_NEAR(normalAt(kRadius).z, 1, 1e-3);
    const Vec3 between = normalAt(kRadius / 2);
    EXPECT_GT(between.z, flat);
    EXPECT_LT(between.z, 1);
}

TEST(ContactForce, RubsAgainstTheTangentialVelocityOnly) {
    const Contact contact = measureContact(patchOf(), {1, 1, 0}, kRadius);
    const double push = norm(contactForce({}, contact, {}));
    const Vec3 force = contactForce({}, contact, {0.002, 0, -0.5});
    EXPECT_NEAR(force.x, -10 * 0.002 * push, 1e-9);
    EXPECT_NEAR(force.y, 0, 1e-9);
    EXPECT_NEAR(force.z, push, 1e-9);
}

TEST(ContactForce, GuardShortensWithoutTurningAndStopsWhatIsNoForce) {
    const Vec3 clamped = guarded({30, 0, 40}, 0);
    EXPECT_NEAR(norm(clamped), kDeviceLimit, 1e-12);
    EXPECT_NEAR(clamped.x / clamped.z, 0.75, 1e-12);
    EXPECT_EQ(guarded({1, 2, 2}, 0).y, 2);
    EXPECT_EQ(norm(guarded({std::nan(""), 0, 1}, 0)), 0);
    EXPECT_EQ(norm(guarded({0, std::numeric_limits<double>::infinity(), 1}, 0)), 0);
    EXPECT_EQ(norm(guarded({0, 0, 1}, 0.051)), 0) << "a stale surface";
    EXPECT_EQ(norm(guarded({0, 0, 1}, std::nan(""))), 0);
}

TEST(ContactForce, HoldsWhileTheToolIsHeld) {
    sand::Scene scene;
    scene.terrain = sand::HeightField(128, 128, 2.0 / 128);
    scene.rules = {.columns = 128,
                   .rows = 128,
                   .threshold = 44204,
                   .startThreshold = 44248,
                   .sweepsPerStep = 40,
                   .stepsPerSecond = 60,
                   .toolRadius = 10 * sand::kProbePerCell};
    sand::Terrain terrain(scene);
    const double radius = scene.toolRadius();
    const sand::ProbePoint centre{64 * sand::kProbePerCell, 64 * sand::kProbePerCell, 0};  // depth R in level sand
    const haptic_bridge::HandMapping mapping(scene, haptic_bridge::HandSettings::Datum::surface);
    double first = 0, last = 0;
    for (std::uint64_t number = 1; number <= 61; ++number) {
        sand::Step step{1, number, true, {}};
        if (number == 1) {
            step.path = {centre};
        }
        terrain.apply(step);
        const SurfacePatch patch(terrain.field(), terrain.probe(), radius);
        const double now = norm(contactForce({}, measureContact(patch, mapping.place(centre), radius), {}));
        first = number == 1 ? now : first;
        if (number > 1) {
            EXPECT_NEAR(now, last, 0.02 * first) << "no jump at step " << number;
        }
        last = now;
        EXPECT_NEAR(now, first, 0.05 * first) << "step " << number;
    }
    EXPECT_GT(first, 0);
}

TEST(SurfacePatch, IsTheFieldAroundTheToolEvenAtACorner) {
    const SurfacePatch slope = patchOf(0.25);
    EXPECT_NEAR(slope.height(1.01, 1.0), 0.0025, 1e-5);
    sand::HeightField tiny(1, 1, 1.0);
    tiny.setHeight(0, 0, sand::kUnitsPerCell);
    EXPECT_NEAR(SurfacePatch(tiny, {-5000, 9000, 0}, 0.5).height(0.1, 0.9), 1.0, 1e-6);
    sand::HeightField wide(4096, 4096, 1.0);
    EXPECT_EQ(SurfacePatch(wide, {0, 0, 0}, 2048).height(10, 10), 0) << "the largest tool fits a patch";
}

}  // namespace
