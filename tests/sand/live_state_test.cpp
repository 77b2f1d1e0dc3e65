// SPDX-License-Identifier: Apache-2.0
// States and saved sand of sessions. A session can read all that it has written.
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <span>
#include <string>

#include "sand/replica.hpp"
#include "tests/sand/spread/sessions.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/tin_scene.hpp"
#include "tests/support/seed.hpp"

namespace {

using sand::Replica;
using sand::Step;

/// Applies a random step and what is owed after it. After each, another replica loads the state and the saved sand, and
/// `inPlace`, which has an earlier state or half of one, loads the state too.
void play(Replica& sand, Replica& inPlace, const scene::Scene& scene, const Step& step, std::mt19937& random) {
    Step next = step;
    for (int part = 0; part == 0 || (sand.owed().any() && part < 40); ++part) {
        next.number = sand.stepNumber() + 1;
        next.sweeps = std::min(1 + static_cast<std::int32_t>(random() % 30), sand.mostSweeps(next));
        sand.apply(next);
        next = {.engaged = sand.engaged()};
        Replica other(scene);
        const base::Bytes state = sand.encodeState();
        ASSERT_EQ(sand.copyState().encode(), state) << "step " << sand.stepNumber();
        ASSERT_NO_THROW(other.decodeState(state)) << "step " << sand.stepNumber();
        if (random() % 4 == 0) {
            EXPECT_THROW(inPlace.decodeStateInPlace(std::span(state).first(random() % state.size())),
                         base::FormatError);
        }
        ASSERT_NO_THROW(inPlace.decodeStateInPlace(state)) << "step " << sand.stepNumber();
        ASSERT_EQ(inPlace.stateHash(), sand.stateHash()) << "step " << sand.stepNumber();
        ASSERT_EQ(inPlace.encodeState(), other.encodeState()) << "step " << sand.stepNumber();
        ASSERT_EQ(other.stateHash(), sand.stateHash()) << "step " << sand.stepNumber();
        ASSERT_EQ(other.movementDigest(), sand.movementDigest()) << "step " << sand.stepNumber();
        ASSERT_NO_THROW((void)sand.sandReader()(sand.copySand()->encode())) << "step " << sand.stepNumber();
    }
}

/// Returns a scene with random sand, laws, rim, rock and walls. In half of the scenes, heights reach the greatest ones.
scene::Scene randomScene(worlds::World& world) {
    scene::Scene scene = samples::flatScene(world.field.columns(), world.field.rows());
    world.rules.tuning.tool.kind = sand::ToolKind::sphere;
    world.rules.stepsPerSecond = 60;
    scene.terrain = world.field;
    scene.rules = world.rules;
    scene.rules.tuning = spread::randomTuning(world.rules, world.random);
    scene.ground = std::move(world.ground);
    for (int y = 0; y < scene.rules.rows && world.random() % 2 == 0; ++y) {
        for (int x = 0; x < scene.rules.columns; ++x) {
            scene.terrain.setHeight(x, y, world.random() % 9 == 0 ? sand::kMaxHeight : scene.terrain.height(x, y));
        }
    }
    return scene;
}

TEST(StatesOfSessions, AreReadAgainOnGrids) {
    const unsigned seed = test::randomSeed();
    for (unsigned i = 0; i < (samples::kSlowBuild ? 20U : 80U); ++i) {
        SCOPED_TRACE(test::again(seed + i));
        worlds::World world(seed + i, 40, 30, false);
        const scene::Scene scene = randomScene(world);
        Replica sand(scene), inPlace(scene);
        for (int step = 0; step < 20 && !testing::Test::HasFatalFailure(); ++step) {
            play(sand, inPlace, scene, spread::randomStep(scene.rules, sand, world.random), world.random);
        }
    }
}

TEST(StatesOfSessions, AreReadAgainOnTins) {
    std::mt19937 random(test::randomSeed());
    for (int i = 0; i < (samples::kSlowBuild ? 4 : 20); ++i) {
        scene::Scene scene = samples::tinScene();
        scene.rules.rim = i % 2 == 0 ? sand::Rim::closed : sand::Rim::open;
        scene.rules.tuning.startThreshold += i % 4 < 2 ? 0 : scene.rules.tuning.threshold / 2;
        Replica sand(scene), inPlace(scene);
        for (int step = 0; step < 20 && !testing::Test::HasFatalFailure(); ++step) {
            play(sand, inPlace, scene, spread::randomStep(scene.rules, sand, random), random);
        }
    }
}

}  // namespace
