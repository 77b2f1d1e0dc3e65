// SPDX-License-Identifier: Apache-2.0
// A tool held in sand that steps under it, or dragged through it: what is felt from update to update.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "sand/force/law.hpp"
#include "tests/sand/force/force_samples.hpp"

namespace {

using namespace sand::force;
using namespace samples;
using sand::Between;
using sand::ForceConstants;

/// A tool in sand that steps under it: what is felt at every tick.
struct Felt {
    double least = 1e9, most = 0;           // [N], |push|
    double jumpAtUpdate = 0, jumpElse = 0;  // [N], of push and friction from a tick to the next
};

/// The tool's lowest point `depth` under the level sand, moving at `speed` [radius per step] after ten steps.
Felt dragged(const ForceConstants& constants, double depth, double speed) {
    const int steps = 10 + (speed > 0 ? static_cast<int>(std::min(50.0, 12 / speed)) : 50);
    sand::Replica terrain(levelScene());
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
            terrain.apply(next);
            next = {1, next.number + 1, true, {}};
            patch = SurfacePatch(terrain.field(), terrain.probe(), kRadius);
        }
        const Response here = model.at(patch, terrain.stepNumber(), tool, place, tick * kTick);
        const Vec3 velocity{moving > 0 ? speed * kRadius : 0, moving > 0 ? speed * kRadius / 3 : 0, 0};
        const Vec3 force = lawfulForce(here, velocity);
        if (tick > 0) {
            double& jump = update ? felt.jumpAtUpdate : felt.jumpElse;
            // That the hand starts to move is no update.
            jump = std::max(jump, moving > 0 && moving < speed * 0.061 ? 0 : norm(force - last));
        }
        last = force;
        felt.least = std::min(felt.least, norm(here.push));
        felt.most = std::max(felt.most, norm(here.push));
    }
    return felt;
}

TEST(LocalModel, HoldsSixtyStepsWhileTheToolIsHeld) {
    for (const auto law : kLaws) {
        const Felt felt = dragged(constantsOf(law), kRadius, 0);
        std::printf("held at one radius: %.4f to %.4f N, at updates at most %.5f N, between %.5f N\n", felt.least,
                    felt.most, felt.jumpAtUpdate, felt.jumpElse);
        EXPECT_GT(felt.least, 0);
        EXPECT_LT(felt.most, 1.05 * felt.least);
        EXPECT_LT(felt.jumpAtUpdate, 0.005 * felt.most) << "no jump";
    }
}

TEST(LocalModel, DoesNotJumpAtAnUpdateWhileDragging) {
    for (const auto law : kLaws) {
        for (const double speed : {0.1, 0.3, 1.0}) {
            for (const double depth : {0.3, 1.0}) {
                const Felt felt = dragged(constantsOf(law), depth * kRadius, speed);
                const Felt held = dragged(constantsOf(law, Between::hold), depth * kRadius, speed);
                std::printf(
                    "dragged %.1f R a step at depth %.1f R: %.3f to %.3f N, at updates at most %.4f N, between "
                    "%.4f N (hold: %.4f N)\n",
                    speed, depth, felt.least, felt.most, felt.jumpAtUpdate, felt.jumpElse, held.jumpAtUpdate);
                EXPECT_LT(felt.jumpAtUpdate, 0.15);
                EXPECT_GT(felt.most, 0);
            }
        }
    }
}

}  // namespace
