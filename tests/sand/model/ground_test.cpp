// SPDX-License-Identifier: Apache-2.0
#include "sand/model/ground.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "scene/model/scene.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::Ground;
using sand::Replica;

/// A thin layer of sand over rock that is steeper than the talus, with a wall through it.
scene::Scene layerOverRock(std::uint32_t seed) {
    scene::Scene scene = samples::flatScene(61, 47, 5);
    auto ground = std::make_shared<Ground>(61, 47);
    std::mt19937 random(seed);
    for (int y = 0; y < 47; ++y) {
        for (int x = 0; x < 61; ++x) {
            const std::int32_t rock = 90000 * (x % 20) + static_cast<std::int32_t>(random() % 40000);
            const std::int32_t layer = x % 3 == 0 ? static_cast<std::int32_t>(random() % 4) : 60000;
            scene.terrain.setHeight(x, y, rock + layer);
            y == 23 && x > 10 ? ground->setWall(x, y) : ground->setBedrock(x, y, rock);
        }
    }
    scene.rules.ground = ground->digest();
    scene.ground = ground;
    return scene;
}

TEST(Ground, RockAndWallsOutlastAnyHand) {
    const scene::Scene scene = layerOverRock(3);
    for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
        scene::Scene rimmed = scene;
        rimmed.rules.rim = rim;
        Replica replica(rimmed);
        std::mt19937 random(5);
        for (std::uint64_t i = 1; i <= 300; ++i) {
            replica.apply(samples::randomStep(i, scene.rules, random));
            ASSERT_EQ(samples::fieldOf(replica).volume() + replica.outflow(), scene.terrain.volume()) << "step " << i;
            for (int y = 0; y < 47; ++y) {
                for (int x = 0; x < 61; ++x) {
                    ASSERT_GE(scene.ground->sand(x, y, samples::fieldOf(replica).height(x, y)), 0)
                        << "a layer thinner than nothing at " << x << ", " << y << " in step " << i << " of seed 5";
                    ASSERT_TRUE(!scene.ground->isWall(x, y) ||
                                samples::fieldOf(replica).height(x, y) == scene.terrain.height(x, y));
                }
            }
        }
    }
}

TEST(Ground, BlocksThreadsAndCodePathsChangeNothing) {
    const scene::Scene scene = layerOverRock(7);
    const auto hashWith = [&](const sand::grid::Erosion::Options& options) {
        Replica replica = samples::replicaSwept(scene, options);
        std::mt19937 random(11);
        for (std::uint64_t i = 1; i <= (samples::kSlowBuild ? 30 : 100); ++i) {
            replica.apply(samples::randomStep(i, scene.rules, random));
        }
        return replica.stateHash();
    };
    const std::uint64_t expected = hashWith({.skipSettled = false});
    // Runs the last task first, which reveals a dependence on the order.
    const base::Executor backwards = [](int count, const std::function<void(int)>& task) {
        for (int i = count - 1; i >= 0; --i) {
            task(i);
        }
    };
    for (const int block : {2, 16, 64}) {
        for (const base::CodePath path : base::codePathsHere()) {
            EXPECT_EQ(hashWith({.blockSize = block, .path = path}), expected) << base::nameOf(path);
            EXPECT_EQ(hashWith({.blockSize = block, .path = path, .executor = &backwards}), expected)
                << base::nameOf(path);
        }
    }
}

// Rock that is too deep for any effect must not change the sand: the limits are exact, not merely close.
TEST(Ground, BottomlessRockIsAsGoodAsNone) {
    scene::Scene scene = samples::flatScene(50, 40);
    std::mt19937 random(13);
    scene.terrain = samples::randomField(50, 40, 1 << 20, random);
    scene::Scene grounded = scene;
    grounded.ground = std::make_shared<Ground>(50, 40);
    grounded.rules.ground = grounded.ground->digest();
    Replica without(scene);
    Replica with(grounded);
    for (std::uint64_t i = 1; i <= 100; ++i) {
        const sand::Step step = samples::randomStep(i, scene.rules, random);
        without.apply(step);
        with.apply(step);
        ASSERT_EQ(with.stateHash(), without.stateHash()) << "step " << i;
    }
}

TEST(Ground, TravelsWithItsScene) {
    const scene::Scene scene = layerOverRock(17);
    const scene::Scene copy = scene::Scene::decode(scene.encode());
    ASSERT_NE(copy.ground, nullptr);
    EXPECT_EQ(copy.ground->digest(), scene.ground->digest());
    EXPECT_EQ(copy.rules.digest(), scene.rules.digest());
    scene::Scene bare = scene;
    bare.rules.ground = 0;
    EXPECT_NE(bare.rules.digest(), scene.rules.digest());
}

}  // namespace
