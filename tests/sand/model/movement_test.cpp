// SPDX-License-Identifier: Apache-2.0
#include "sand/model/movement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/sand/spread/sessions.hpp"
#include "tests/support/sand/hostile_sand.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/tin_scene.hpp"
#include "tests/support/seed.hpp"

namespace {

using sand::Movement;
using sand::Replica;

const Movement& movementOf(const Replica& replica) { return *replica.surface().movement(); }

/// Returns the bytes of runs of movement: length and number of each.
base::Bytes runs(std::initializer_list<std::uint64_t> numbers) {
    base::ByteWriter writer;
    for (const std::uint64_t number : numbers) {
        writer.putVarint(number);
    }
    return writer.take();
}

std::string whyRefused(const base::Bytes& bytes) {
    try {
        (void)Movement::decode(bytes, 9, 6);
    } catch (const base::FormatError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Movement, SurvivesItsEncoding) {
    Movement movement{.step = 9, .newest = 9, .moved = {0, 0, 7, 9, 9, 0}};
    base::ByteWriter writer;
    movement.encode(writer);
    EXPECT_EQ(writer.bytes(), runs({2, 0, 1, 7, 2, 9, 1, 0}));
    const Movement read = Movement::decode(writer.bytes(), 9, 6);
    EXPECT_EQ(read.moved, movement.moved);
    EXPECT_EQ(read.newest, 9U);
    EXPECT_EQ(read.step, 9U);
    EXPECT_EQ(read.digest(), movement.digest());
    ++movement.moved[2];
    EXPECT_NE(read.digest(), movement.digest());
}

TEST(Movement, OfAWrongStateIsRefusedByName) {
    EXPECT_EQ(whyRefused(runs({6, 9})), "accepted");
    EXPECT_EQ(whyRefused(runs({2, 0, 4, 10})),
              "movement: step 10 moved the sand of hash tile 2, but the state is of step 9");
    EXPECT_EQ(whyRefused(runs({5, 0})), "movement: numbers for 5 of 6 hash tiles");
    EXPECT_EQ(whyRefused({}), "movement: numbers for 0 of 6 hash tiles");
    EXPECT_EQ(whyRefused(runs({5, 0, 2, 1})), "movement: a run of 2 after 5 of 6 hash tiles");
    EXPECT_EQ(whyRefused(runs({~std::uint64_t{0}, 0})),
              "movement: a run of 18446744073709551615 after 0 of 6 hash tiles");
    EXPECT_EQ(whyRefused(runs({6, 0, 0, 1})), "movement: a run of 0 after 6 of 6 hash tiles");
    EXPECT_EQ(whyRefused(runs({3, 1, 3, 1})), "movement: two runs of step 1 beside each other");
    EXPECT_NE(whyRefused(runs({6})), "accepted");
}

TEST(Movement, IsTheLastStepThatChangedAHeightInAHashTile) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const scene::Scene scene = samples::flatScene(100, 70);
    Replica replica(scene);
    ASSERT_EQ(replica.hashTiles().tileCount(), 12);
    std::vector<std::uint64_t> expected(12, 0);
    std::size_t moved = 0, rested = 0;
    for (std::uint64_t number = 1; number <= 120; ++number) {
        const sand::HeightField before = samples::fieldOf(replica);
        sand::Step step = spread::randomStep(scene.rules, replica, random);
        step.number = number;
        replica.apply(step);
        for (std::size_t tile = 0; tile < expected.size(); ++tile) {
            bool changed = false;
            const sand::CellRect cells = replica.hashTiles().cellsOf(static_cast<int>(tile));
            for (int y = cells.y0; y < cells.y1; ++y) {
                changed = changed || !std::equal(before.row(y) + cells.x0, before.row(y) + cells.x1,
                                                 samples::fieldOf(replica).row(y) + cells.x0);
            }
            expected[tile] = changed ? number : expected[tile];
            ++(changed ? moved : rested);
        }
        ASSERT_EQ(movementOf(replica).moved, expected) << "step " << number;
        ASSERT_EQ(movementOf(replica).step, number);
        ASSERT_EQ(movementOf(replica).newest, std::ranges::max(expected));
    }
    EXPECT_GT(moved, 100U);
    EXPECT_GT(rested, 100U);
}

// A replica visits and marks other blocks than its twin. Some hash the sand only now and then. One is resumed from its
// state after each step.
TEST(Movement, IsTheSameHoweverTheSandIsSweptAndHashed) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const scene::Scene scene = samples::flatScene(100, 70);
    std::vector<Replica> replicas;
    replicas.emplace_back(scene);
    for (const int block : {2, 13, 64}) {
        replicas.push_back(samples::replicaSwept(scene, {.blockSize = block, .skipSettled = block != 13}));
    }
    replicas.push_back(samples::replicaSwept(scene, {.path = base::CodePath::baseline}));
    Replica resumed(scene);
    for (std::uint64_t number = 1; number <= 100; ++number) {
        sand::Step step = spread::randomStep(scene.rules, replicas.front(), random);
        step.number = number;
        for (Replica& replica : replicas) {
            replica.apply(step);
        }
        resumed.apply(step);
        (void)resumed.stateHash();
        Replica fresh(scene);
        fresh.decodeState(resumed.encodeState());
        resumed = fresh;
        for (const Replica& replica : replicas) {
            ASSERT_EQ(movementOf(replica).moved, movementOf(replicas.front()).moved) << "step " << number;
        }
        ASSERT_EQ(resumed.movementDigest(), replicas.front().movementDigest()) << "step " << number;
        ASSERT_EQ(resumed.surface().movement()->newest, movementOf(replicas.front()).newest) << "step " << number;
    }
}

TEST(Movement, OfAReplicaIsCorruptedWithoutItsSand) {
    Replica replica(samples::flatScene(100, 70));
    const std::uint64_t hash = replica.stateHash(), digest = replica.movementDigest();
    replica.corruptMovement(70, 40);
    EXPECT_EQ(movementOf(replica).moved.at(4 + 2), 1U);
    EXPECT_EQ(replica.stateHash(), hash);
    EXPECT_NE(replica.movementDigest(), digest);
}

TEST(Movement, IsNotRecordedForATin) {
    Replica replica(samples::tinScene());
    EXPECT_EQ(replica.surface().movement(), nullptr);
    EXPECT_FALSE(samples::tinScene().recordsMovement());
    EXPECT_TRUE(samples::flatScene(8, 8).recordsMovement());
    replica.corruptMovement(0, 0);
    EXPECT_EQ(replica.movementDigest(), 0U);
    Replica other(samples::tinScene());
    EXPECT_NO_THROW(other.decodeState(replica.encodeState()));
}

TEST(Movement, OfAnotherStateIsRefusedAndTheReplicaStaysAsItIs) {
    const scene::Scene scene = samples::flatScene(100, 70);
    Replica replica(scene);
    replica.apply({1, 1, true, {{2000, 2000, 200}, {3000, 2500, 100}}});
    const std::uint64_t digest = replica.movementDigest();
    const auto stateOf = [&](const base::Bytes& movement) {
        sand::StateCopy copy = replica.copyState();
        copy.movement = movement;
        return copy.encode();
    };
    for (const base::Bytes& wrong : {runs({12, 2}), runs({11, 0}), base::Bytes()}) {
        EXPECT_THROW(replica.decodeState(stateOf(wrong)), base::FormatError);
        EXPECT_EQ(replica.movementDigest(), digest);
    }
    EXPECT_NO_THROW(replica.decodeState(stateOf(runs({12, 1}))));
}

}  // namespace
