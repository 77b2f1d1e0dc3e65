// SPDX-License-Identifier: Apache-2.0
#include "master/steps/master_sand.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/machine/memory_limit.hpp"
#include "tests/support/sand/high_sand.hpp"
#include "tests/support/sand/hostile_sand.hpp"
#include "tests/support/sand/no_steps.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace {

using lockstep::Fault;
using master::ArrivedStep;

/// Notes the states for which reached() is called.
class Notes : public test::NoSteps {
public:
    void reached(sand::Replica& sand) override { reachedSteps.push_back(sand.stepNumber()); }

    std::vector<std::uint64_t> reachedSteps;
};

const scene::Scene& sceneOfTest() {
    static const scene::Scene scene = samples::flatScene(128, 96);
    return scene;
}

std::vector<ArrivedStep> stepsFrom(std::uint64_t first, std::size_t count, std::mt19937& random) {
    std::vector<ArrivedStep> steps(count);
    for (ArrivedStep& timed : steps) {
        timed.step = samples::randomStep(first++, sceneOfTest().rules, random);
    }
    return steps;
}

TEST(MasterSand, AppliesTheStepsOfAFrameAndTellsOfEachState) {
    std::mt19937 random(3);
    master::MasterSand sand{sand::Replica{sceneOfTest()}};
    sand::Replica plain(sceneOfTest());
    EXPECT_EQ(sand.hash(), plain.stateHash());
    Notes notes;
    std::vector<ArrivedStep> steps = stepsFrom(1, 3, random);
    steps[1].step.edit = sand::Edit::settle;
    sand.apply(1, steps, 4, notes);
    for (const ArrivedStep& timed : steps) {
        plain.apply(timed.step);
    }
    EXPECT_EQ(sand.hash(), plain.stateHash());
    EXPECT_EQ(notes.reachedSteps, (std::vector<std::uint64_t>{0, 1, 2, 3}));
    EXPECT_EQ(sand.edits(), 1U);
}

// A drill flips a bit of the master's own sand in its frame only. The state hash changes when the tile is hashed again.
TEST(MasterSand, InjectsTheFaultsOfTheMasterAlone) {
    const Fault mine{.kind = Fault::Kind::diverge, .rank = 0, .frame = 2, .column = 5, .row = 5, .bit = 3};
    Fault others = mine;
    others.rank = 1;
    others.frame = 1;
    master::MasterSand sand(sand::Replica{sceneOfTest()}, {mine, others});
    const std::uint64_t right = sand.hash();
    const auto all = static_cast<std::uint32_t>(sand.replica().hashTiles().tileCount());
    Notes notes;
    sand.apply(1, {}, all, notes);
    EXPECT_EQ(sand.hash(), right) << "the fault of another rank";
    sand.apply(2, {}, all, notes);
    EXPECT_NE(sand.hash(), right);
}

// A haptic server can send sand of 33 KB that claims 2^30 vertices.
TEST(MasterSand, GoesOnAfterALoadThatClaimsTooMuch) {
    const scene::Scene scene = samples::tinScene();
    const base::Bytes dead = hostile_sand::ofDeadVertices(*scene.tin, std::uint64_t{1} << 30);
    const std::string said = test::inTwoGiB([&] {
        Notes notes;
        master::MasterSand sand{sand::Replica{scene}};
        std::vector<ArrivedStep> steps(2);
        steps[0].step = {.epoch = 1, .number = 1, .engaged = false, .path = {}, .edit = sand::Edit::loaded(dead)};
        steps[1].step = {.epoch = 1, .number = 2, .engaged = false, .path = {}};
        sand.apply(1, steps, 0, notes);
        const std::vector<master::LeftOut> leftOut = sand.takeLeftOut();
        if (sand.replica().stepNumber() != 2 || leftOut.size() != 1 || leftOut[0].step != 1 ||
            !sand.takeLeftOut().empty()) {
            throw std::runtime_error("not all steps were applied, or the load was not reported");
        }
    });
    EXPECT_EQ(said, "done");
}

TEST(MasterSand, GoesOnWithTheSandOfASessionThatStopped) {
    std::mt19937 random(5);
    Notes notes;
    master::MasterSand before{sand::Replica{sceneOfTest()}};
    before.apply(1, stepsFrom(1, 6, random), 0, notes);
    const master::MasterSand after(before.replica(), {}, 4);
    EXPECT_EQ(after.hash(), before.hash());
    EXPECT_EQ(after.replica().stepNumber(), 6U);
    EXPECT_EQ(after.edits(), 4U);
}

TEST(MasterSand, CountsTheStepsWithARefusedPressAndKnowsTheFirst) {
    Notes notes;
    master::MasterSand sand{sand::Replica{samples::highScene(10)}};
    EXPECT_EQ(sand.stepsUnplaced(), 0U);
    EXPECT_EQ(sand.firstStepUnplaced(), 0U);
    std::vector<ArrivedStep> steps(3);
    steps[0].step = {.number = 1};
    steps[1].step = {.number = 2, .engaged = true, .path = {samples::aboveHighSand(2, 30), samples::aboveHighSand(2)}};
    steps[2].step = {.number = 3, .engaged = true};  // the tool does not move
    sand.apply(1, steps, 0, notes);
    EXPECT_EQ(sand.stepsUnplaced(), 1U) << "one step with several sub-steps";
    EXPECT_EQ(sand.firstStepUnplaced(), 2U);
    steps.resize(1);
    steps[0].step = {.number = 4, .engaged = true, .path = {samples::aboveHighSand(2, 28)}};
    sand.apply(2, steps, 0, notes);
    EXPECT_EQ(sand.stepsUnplaced(), 2U);
    EXPECT_EQ(sand.firstStepUnplaced(), 2U) << "the first one stays the first";
}

// All tiles are hashed again in a second at any frame rate. Every frame hashes some tiles, and none hashes a tile
// twice.
TEST(MasterSand, ReadsAllOfItsMemoryAgainInASecond) {
    const master::MasterSand sand{sand::Replica{sceneOfTest()}};
    const auto tiles = static_cast<std::uint32_t>(sand.replica().hashTiles().tileCount());
    ASSERT_GT(tiles, 2U);
    for (const int rate : {1, 10, 30, 60}) {
        EXPECT_GE(sand.auditTiles(1.0 / rate) * static_cast<std::uint32_t>(rate), tiles) << rate << " frames a second";
    }
    EXPECT_GE(sand.auditTiles(0), 1U) << "the first frame";
    EXPECT_EQ(sand.auditTiles(100), tiles);
}

}  // namespace
