// SPDX-License-Identifier: Apache-2.0
// A tool that is held in sand while the sand steps, or is dragged through it: the force from update to update.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "sand/force/law.hpp"
#include "sand/replica.hpp"
#include "tests/sand/force/force_samples.hpp"
#include "tests/support/sand/sand_of.hpp"

namespace {

using namespace sand::force;
using namespace samples;
using sand::Between;
using sand::ForceConstants;

/// Force at every tick on a tool in sand that steps below it.
struct Felt {
    double least = 1e9, most = 0;           // [N], |push|
    double jumpAtUpdate = 0, jumpElse = 0;  // change of push and friction between two ticks [N]
};

/// Moves a tool whose lowest point is `depth` below the level sand, at `speed` [radius per step], after ten steps.
Felt dragged(const ForceConstants& constants, double depth, double speed) {
    const int steps = 10 + (speed > 0 ? static_cast<int>(std::min(50.0, 12 / speed)) : 50);
    sand::Replica replica(levelScene());
    ForceModel model(constants);
    const Contour tool = Contour::sphere(kRadius);
    SurfacePatch patch;
    Felt felt;
    Vec3 last;
    sand::Step next{1, 1, true, {}};
    for (int tick = 0; tick < steps * 1000 / 60; ++tick) {
        const double moving = std::max(0.0, tick * kTick * 60 - 10) * speed;  // [radius]
        const Vec3 place = placeAt(depth, kRadius * (moving - 4), kRadius * moving / 3);
        next.path.push_back(probeAt(place));
        const bool update = tick * 60 / 1000 != (tick - 1) * 60 / 1000 || tick == 0;
        if (update) {
            replica.apply(next);
            next = {1, next.number + 1, true, {}};
            patch = SurfacePatch(samples::fieldOf(replica), replica.probe(), kRadius);
        }
        const Response here = model.at(patch, replica.stepNumber(), tool, place, tick * kTick);
        const Vec3 velocity{moving > 0 ? speed * kRadius : 0, moving > 0 ? speed * kRadius / 3 : 0, 0};
        const Vec3 force = lawfulForce(here, velocity);
        if (tick > 0) {
            double& jump = update ? felt.jumpAtUpdate : felt.jumpElse;
            // The start of the hand's motion does not count as an update.
            jump = std::max(jump, moving > 0 && moving < speed * 0.061 ? 0 : norm(force - last));
        }
        last = force;
        felt.least = std::min(felt.least, norm(here.push));
        felt.most = std::max(felt.most, norm(here.push));
    }
    return felt;
}

// docs/figures.md: the push of either law stays within 1.1 %, and no update changes it by more than 0.0001 N.
TEST(LocalModel, HoldsSixtyStepsWhileTheToolIsHeld) {
    for (const auto law : kLaws) {
        const Felt felt = dragged(constantsOf(law), kRadius, 0);
        std::printf("held at one radius: %.4f to %.4f N, at updates at most %.5f N, between %.5f N\n", felt.least,
                    felt.most, felt.jumpAtUpdate, felt.jumpElse);
        EXPECT_GT(felt.least, 0);
        EXPECT_LT(felt.most, 1.011 * felt.least);
        EXPECT_LT(felt.jumpAtUpdate, 0.0001) << "no jump";
    }
}

/// Row of the table of jumps in docs/figures.md.
struct Jump {
    sand::ForceLaw law;
    double depth, speed;         // [tool radius], [tool radius/step]
    double leastPush, mostPush;  // [N]
    double local, hold;          // [N], at an update
};
constexpr std::array kJumps{Jump{sand::ForceLaw::repulse, 0.3, 0.1, 1.56, 1.73, 0.001, 0.018},
                            Jump{sand::ForceLaw::repulse, 0.3, 0.3, 1.55, 1.73, 0.002, 0.042},
                            Jump{sand::ForceLaw::repulse, 0.3, 1.0, 1.48, 1.66, 0.014, 0.076},
                            Jump{sand::ForceLaw::repulse, 1.0, 0.1, 5.90, 6.48, 0.002, 0.039},
                            Jump{sand::ForceLaw::repulse, 1.0, 0.3, 5.90, 6.59, 0.006, 0.084},
                            Jump{sand::ForceLaw::repulse, 1.0, 1.0, 4.93, 6.20, 0.036, 0.300},
                            Jump{sand::ForceLaw::controlPoints, 0.3, 0.1, 0.15, 0.19, 0.001, 0.014},
                            Jump{sand::ForceLaw::controlPoints, 0.3, 0.3, 0.13, 0.19, 0.001, 0.023},
                            Jump{sand::ForceLaw::controlPoints, 0.3, 1.0, 0.12, 0.16, 0.002, 0.025},
                            Jump{sand::ForceLaw::controlPoints, 1.0, 0.1, 0.41, 0.48, 0.002, 0.058},
                            Jump{sand::ForceLaw::controlPoints, 1.0, 0.3, 0.43, 0.54, 0.003, 0.067},
                            Jump{sand::ForceLaw::controlPoints, 1.0, 1.0, 0.40, 0.47, 0.006, 0.114}};

// Every machine computes the same sand. Forces differ only in the last digits of a library's functions. A figure of the
// table is exact to half of its last digit, plus a tenth of that digit for the number that was rounded.
TEST(LocalModel, DoesNotJumpAtAnUpdateWhileDragging) {
    constexpr double kHundredth = 0.006, kThousandth = 0.0006;  // [N]
    for (const Jump& row : kJumps) {
        const Felt felt = dragged(constantsOf(row.law), row.depth * kRadius, row.speed);
        const Felt held = dragged(constantsOf(row.law, Between::hold), row.depth * kRadius, row.speed);
        std::printf(
            "dragged %.1f R a step at depth %.1f R: %.3f to %.3f N, at updates at most %.4f N, between %.4f N (hold: "
            "%.4f N)\n",
            row.speed, row.depth, felt.least, felt.most, felt.jumpAtUpdate, felt.jumpElse, held.jumpAtUpdate);
        EXPECT_NEAR(felt.least, row.leastPush, kHundredth);
        EXPECT_NEAR(felt.most, row.mostPush, kHundredth);
        EXPECT_NEAR(felt.jumpAtUpdate, row.local, kThousandth);
        EXPECT_NEAR(held.jumpAtUpdate, row.hold, kThousandth);
    }
}

}  // namespace
