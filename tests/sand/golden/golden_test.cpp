// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "host/worker_pool.hpp"
#include "sand/grid/dunes.hpp"
#include "sand/grid/settle.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using Options = sand::grid::Erosion::Options;

/// Expects the same hash on every code path of this CPU, with one thread and with three. Builds with sanitizers leave
/// out the threads, which the tests of the walk and of the covers have, too.
void expectHash(const std::string& expected, const std::function<std::uint64_t(const Options&)>& hashWith) {
    host::WorkerPool team(3);
    for (const base::CodePath path : base::codePathsHere()) {
        EXPECT_EQ(fmt::format("{:016x}", hashWith({.path = path})), expected) << base::nameOf(path);
        if (!samples::kSanitized) {
            EXPECT_EQ(fmt::format("{:016x}", hashWith({.path = path, .executor = team.lend()})), expected)
                << base::nameOf(path) << ", three threads";
        }
    }
}

/// Returns the hash after 400 steps of a random hand over dunes on a field of odd size.
std::uint64_t hashOfSession(sand::Scheme scheme, sand::Rim rim, const Options& options) {
    scene::Scene scene = samples::flatScene(97, 61, 2.56);
    sand::grid::makeDunes({.bed = 2, .height = 6, .length = 30, .seed = 5}, scene.terrain);
    scene.rules.scheme = scheme;
    scene.rules.rim = rim;
    sand::Replica replica = samples::replicaSwept(scene, options);
    std::mt19937 random(43);
    for (std::uint64_t i = 1; i <= 400; ++i) {
        replica.apply(samples::randomStep(i, scene.rules, random));
    }
    return replica.stateHash();
}

// These numbers must be the same with every compiler, level of optimisation and machine. They were accepted when
// volume, symmetry and oracle tests beside this file passed, and g++ and clang agreed at -O0 to -O3. A change of the
// algorithm raises kAlgorithmVersion and replaces them.
TEST(Golden, SessionHashesAreTheSameEverywhere) {
    using enum sand::Scheme;
    using enum sand::Rim;
    expectHash("83c6067b8e398972", [](const Options& how) { return hashOfSession(isotropic, closed, how); });
    expectHash("f44f90b2079bf64c", [](const Options& how) { return hashOfSession(isotropic, open, how); });
}

struct Variant {
    const char* name;
    std::int32_t aspect;          // [2^-16]
    std::int32_t startThreshold;  // [unit]
    bool rock, walls;
    sand::Rim rim;
    const char* hash;
};

/// Returns rock that rises to the east and is bare in places, with a block and a stair of walls.
std::shared_ptr<const sand::Ground> groundOf(const Variant& variant, const sand::HeightField& field) {
    auto ground = std::make_shared<sand::Ground>(field.columns(), field.rows());
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            if (variant.walls && ((x > 30 && x < 42 && y > 20 && y < 25) || (x == y && x > 44 && x < 56))) {
                ground->setWall(x, y);
            } else if (variant.rock) {
                ground->setBedrock(x, y, std::min(field.height(x, y), (x - 20) * sand::kUnitsPerCell / 8));
            }
        }
    }
    return ground;
}

/// Returns the hash after so many steps of a random hand that each run all their sweeps.
std::uint64_t hashOf(scene::Scene scene, const Variant& variant, std::uint64_t steps, std::mt19937 random,
                     const Options& options) {
    scene.rules.aspect = variant.aspect;
    scene.rules.tuning.startThreshold = variant.startThreshold;
    scene.rules.rim = variant.rim;
    if (variant.rock || variant.walls) {
        scene.ground = groundOf(variant, scene.terrain);
        scene.rules.ground = scene.ground->digest();
    }
    sand::Replica replica = samples::replicaSwept(scene, options);
    for (std::uint64_t i = 1; i <= steps; ++i) {
        sand::Step step = samples::randomStep(i, scene.rules, random);
        step.sweeps = 0;
        replica.apply(step);
    }
    return replica.stateHash();
}

// Each variant has a kernel of its own, or uses doubles that plain sand does not have. These are doubles for the band,
// the limits of a layer, or the two lengths of a cell. The hashes were accepted in the same way as the session hashes.
TEST(Golden, BandRockWallsAndLongCellsAreTheSameEverywhere) {
    using enum sand::Rim;
    constexpr std::int32_t kOne = sand::kUnitsPerCell;
    scene::Scene scene = samples::flatScene(97, 61, 2.56);
    sand::grid::makeDunes({.bed = 2, .height = 6, .length = 30, .seed = 5}, scene.terrain);
    for (const Variant& variant :
         {Variant{"band", kOne, kOne + kOne / 5, false, false, closed, "7609b872b40ca39a"},
          {"rock", kOne, kOne, true, false, closed, "4ad42921d8147798"},
          {"walls", kOne, kOne, false, true, open, "6fcd2d1920e9a856"},
          {"cells twice as long", 2 * kOne, kOne, false, false, closed, "ad5e326fc0f96e6b"},
          {"all of it", 3 * kOne / 4, kOne + kOne / 10, true, true, open, "f1cd71bb8c924049"}}) {
        SCOPED_TRACE(variant.name);
        expectHash(variant.hash,
                   [&](const Options& how) { return hashOf(scene, variant, 200, std::mt19937(43), how); });
    }
}

// Tools of every shape, turned and changed at random. No compiler may fuse the operations of the doubles that turn,
// square and divide.
TEST(Golden, ASessionOfEveryToolIsTheSameEverywhere) {
    scene::Scene scene = samples::flatScene(45, 33, 6);
    sand::grid::makeDunes({.bed = 2, .height = 4, .length = 20, .seed = 3}, scene.terrain);
    scene.rules.rim = sand::Rim::open;
    scene.rules.tuning.tool.kind = sand::ToolKind::footprint;
    scene.rules.tuning.tool.halfWidth = scene.rules.tuning.tool.radius * 2 / 5;
    sand::Replica replica(scene);
    std::mt19937 random(73);
    for (std::uint64_t i = 1; i <= 400; ++i) {
        replica.apply(samples::wildStep(i, scene.rules, random));
    }
    EXPECT_EQ(fmt::format("{:016x}", replica.stateHash()), "ab621661f1f4268d");
}

// A tool with a coarse phase. The tests of CoarseLevel and LargeTool say that its sand is right.
TEST(Golden, ALargeToolIsTheSameEverywhere) {
    using enum sand::Rim;
    constexpr std::int32_t kOne = sand::kUnitsPerCell;
    scene::Scene scene = samples::flatScene(141, 122, 25);
    sand::grid::makeDunes({.bed = 8, .height = 6, .length = 40, .seed = 7}, scene.terrain);
    scene.rules.tuning.sweepsPerStep = 105;
    for (const Variant& variant :
         {Variant{"level", kOne, kOne, false, false, closed, "5db42e60275f94ce"},
          {"open rim and band", kOne, kOne + kOne / 10, false, false, open, "d308c60fec2c29e0"},
          {"rock and walls", kOne, kOne, true, true, open, "7c422daf848480f4"}}) {
        SCOPED_TRACE(variant.name);
        expectHash(variant.hash, [&](const Options& how) { return hashOf(scene, variant, 40, std::mt19937(47), how); });
    }
}

/// Returns the hash of noise after settle().
std::uint64_t hashOfSettled(sand::Rim rim) {
    scene::Scene scene = samples::flatScene(97, 61);
    std::mt19937 random(47);
    scene.terrain = samples::randomField(97, 61, 12 * sand::kUnitsPerCell, random);
    scene.rules.rim = rim;
    sand::grid::settle(scene.terrain, scene.rules);
    return sand::Replica(scene).stateHash();
}

// The projection computes with doubles. Their sums decide when to reset the momentum and when to stop, so that every
// compiler must add them in the same order. The hashes were accepted in the same way as the session hashes.
TEST(Golden, SettledFieldsAreTheSameEverywhere) {
    EXPECT_EQ(fmt::format("{:016x}", hashOfSettled(sand::Rim::closed)), "3d57e3ffe9a02bcc");
    EXPECT_EQ(fmt::format("{:016x}", hashOfSettled(sand::Rim::open)), "e962ac8ddf32971e");
}

}  // namespace
