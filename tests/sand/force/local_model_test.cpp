// SPDX-License-Identifier: Apache-2.0
// The force between two surfaces: computed a thousand times per second, while the sand steps sixty times.
#include <gtest/gtest.h>

#include <algorithm>

#include "sand/force/law.hpp"
#include "tests/sand/force/force_samples.hpp"

namespace {

using namespace sand::force;
using namespace samples;
using sand::Between;
using sand::ForceConstants;

constexpr std::array kBetween{Between::local, Between::hold, Between::interpolate};

TEST(LocalModel, IsTheLawWhereItWasMade) {
    const Contour tool = Contour::sphere(kRadius);
    for (const auto law : kLaws) {
        for (const Between between : kBetween) {
            const ForceConstants constants = constantsOf(law, between);
            const SurfacePatch rough = roughPatch(3);
            ForceModel model(constants);
            const Response here = model.at(rough, 1, tool, placeAt(kRadius), 0);
            const Response exact = respond(constants, rough, tool, placeAt(kRadius));
            EXPECT_EQ(norm(here.push - exact.push), 0);
            EXPECT_EQ(here.drag, exact.drag);
            EXPECT_GT(norm(here.push), 0);
        }
    }
}

TEST(LocalModel, FollowsTheLawToFirstOrderAndHoldDoesNot) {
    const Contour tool = Contour::sphere(kRadius);
    const SurfacePatch rough = roughPatch(4);
    for (const auto law : kLaws) {
        for (const double size : {1e-5, 2e-5}) {
            const Vec3 step{size, size / 2, -size};
            const auto error = [&](Between between) {
                ForceConstants constants = constantsOf(law, between);
                constants.recoveryTime = 0;
                ForceModel model(constants);
                // Two surfaces, because the model assumes a horizontal tangent only after it has come true.
                (void)model.at(rough, 1, tool, placeAt(0.7 * kRadius, -0.11 * kRadius), 0);
                (void)model.at(rough, 2, tool, placeAt(0.7 * kRadius), kTick);
                const Vec3 there = model.at(rough, 2, tool, placeAt(0.7 * kRadius) + step, 2 * kTick).push;
                return norm(there - respond(constantsOf(law), rough, tool, placeAt(0.7 * kRadius) + step).push);
            };
            // The law of Purchart et al. 2012 has a secant across, and no tangent.
            const double share = law == sand::ForceLaw::repulse ? 0.02 : 0.2;
            EXPECT_LT(error(Between::local), share * error(Between::hold)) << size;
        }
    }
}

TEST(LocalModel, IsMadeAnewBeyondItsRadius) {
    const Contour tool = Contour::sphere(kRadius);
    const SurfacePatch rough = roughPatch(5);
    const ForceConstants constants = constantsOf(sand::ForceLaw::repulse);
    ForceModel model(constants);
    Vec3 last{};
    // The tool moves four radii in 200 ticks, which is more than the model's validity. The push must follow the sand
    // and must not jump.
    for (int tick = 0; tick <= 200; ++tick) {
        const Vec3 place = placeAt(0.7 * kRadius, kRadius * (tick / 50.0 - 2));
        const Vec3 push = model.at(rough, 1, tool, place, tick * kTick).push;
        const Vec3 exact = respond(constants, rough, tool, place).push;
        EXPECT_LT(norm(push - exact), 0.1 * norm(exact) + 0.1) << tick;
        if (tick > 0) {
            EXPECT_LT(norm(push - last), 0.15) << tick;
        }
        last = push;
    }
}

TEST(LocalModel, ForgetsWhatItKnewBeforeAGapOrALeap) {
    const Contour tool = Contour::sphere(kRadius);
    const ForceConstants constants = constantsOf(sand::ForceLaw::repulse);
    const SurfacePatch level = levelPatch(), rough = roughPatch(6);
    ForceModel model(constants);
    (void)model.at(level, 1, tool, placeAt(3 * kRadius), 0);
    const Vec3 late = model.at(rough, 2, tool, placeAt(kRadius), 0.2).push;
    EXPECT_EQ(norm(late - respond(constants, rough, tool, placeAt(kRadius)).push), 0);
    const Vec3 far = model.at(rough, 2, tool, placeAt(kRadius, 2.5 * kRadius), 0.201).push;
    EXPECT_EQ(norm(far - respond(constants, rough, tool, placeAt(kRadius, 2.5 * kRadius)).push), 0);
    (void)model.at(SurfacePatch{}, 3, tool, placeAt(kRadius), 0.202);
    EXPECT_EQ(norm(model.at(rough, 3, tool, placeAt(-9 * kRadius), 0.203).push), 0);
}

TEST(LocalModel, TakesOverFromTheOldSurfaceWithinItsRecovery) {
    const Contour tool = Contour::sphere(kRadius);
    for (const auto law : kLaws) {
        const ForceConstants constants = constantsOf(law);
        const SurfacePatch level = levelPatch(), raised = patchOf([](double, double) { return kRadius / 4; });
        const double before = norm(respond(constants, level, tool, placeAt(kRadius)).push);
        const double after = norm(respond(constants, raised, tool, placeAt(kRadius)).push);
        ForceModel model(constants);
        (void)model.at(level, 1, tool, placeAt(kRadius), 0);
        const int timeConstant = law == sand::ForceLaw::controlPoints ? 100 : 50;  // [tick], of a hand at rest
        double last = before;
        for (int tick = 1; tick <= 4000; ++tick) {
            const double now = norm(model.at(raised, 2, tool, placeAt(kRadius), tick * kTick).push);
            EXPECT_LE(now - last, (after - before) * kTick / constants.recoveryTime * 1.05) << tick;
            EXPECT_TRUE(tick != timeConstant || std::abs((after - now) / (after - before) - std::exp(-1)) < 0.01)
                << "a time constant";
            EXPECT_GE(now - last, -1e-12) << tick;
            last = now;
        }
        EXPECT_NEAR(last, after, 1e-6);
    }
}

}  // namespace
