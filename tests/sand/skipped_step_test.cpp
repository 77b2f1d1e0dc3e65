// SPDX-License-Identifier: Apache-2.0
// A step that the sand cannot take. No state and no step are known that make the sand throw, so the executor of its
// sweeps does. It throws in the middle of a sweep, when the sand is half changed.
#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <random>
#include <stdexcept>

#include "sand/replica.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::Replica;

/// An executor that throws a Failure in its call number `at`, counted from arm(), after `tasks` of that call's tasks.
template <class Failure>
class FailingExecutor {
public:
    void arm(int at, int tasks) {
        left_ = at;
        tasks_ = tasks;
    }
    [[nodiscard]] bool thrown() const { return thrown_; }
    [[nodiscard]] const base::Executor* lend() const { return &executor_; }

private:
    void work(int count, const std::function<void(int)>& task) {
        const bool fails = left_ == 0;
        left_ -= left_ >= 0 ? 1 : 0;
        for (int i = 0; i < count; ++i) {
            if (fails && i == tasks_) {
                thrown_ = true;
                throw Failure();
            }
            task(i);
        }
    }

    int left_ = -1, tasks_ = 0;
    bool thrown_ = false;
    base::Executor executor_ = [this](int count, const std::function<void(int)>& task) { work(count, task); };
};

struct Overflow : std::overflow_error {
    Overflow() : std::overflow_error("too much sand") {}
};

class SkippedStep : public testing::Test {
protected:
    static constexpr int kBlock = 8;                   // [cell]
    static constexpr int kColumns = 192, kRows = 128;  // large enough that a sweep has several tasks

    SkippedStep() {
        // Columns of blocks that are too steep, between columns of blocks at rest. So each row of blocks has several
        // runs.
        std::mt19937 random(7);
        const sand::HeightField rough = samples::randomField(kColumns, kRows, 4 * sand::kUnitsPerCell, random);
        for (int y = 0; y < rough.rows(); ++y) {
            for (int x = 0; x < rough.columns(); ++x) {
                scene_.terrain.setHeight(x, y, x / 24 % 2 == 0 ? rough.height(x, y) : 0);
            }
        }
    }
    [[nodiscard]] Replica replicaOn(const base::Executor* executor) const {
        return samples::replicaSwept(scene_, {.blockSize = kBlock, .executor = executor});
    }
    /// Returns step `number` of a hand that digs from step 1 to 2, lifts in step 3 and digs again from step 4 on.
    static sand::Step digging(std::uint64_t number) {
        const auto x = static_cast<std::int32_t>(2000 + 300 * number);
        return {.epoch = 1, .number = number, .engaged = number != 3, .path = {{x, 2000, -100}}};
    }
    /// Returns step `number` of the same hand, in which the hand also turns and an operator changes the material.
    [[nodiscard]] sand::Step changing(std::uint64_t number) const {
        sand::Step step = digging(number);
        step.heading = sand::Heading{0, sand::Heading::kLength};
        step.edit = sand::Edit::tune;
        step.edit.tuning = scene_.rules.tuning;
        step.edit.tuning.threshold /= 4;
        step.edit.tuning.startThreshold /= 4;
        return step;
    }

    scene::Scene scene_ = samples::flatScene(kColumns, kRows);
};

// The two replicas fail at different places of the step, with which a stroke begins. Only the tool has marked sand as
// changed by then. In one replica all sand has slid already, because the step also makes it slide at smaller slopes.
// Equal hashes and states show that nothing is left of the step.
TEST_F(SkippedStep, LeavesEveryReplicaEqualHoweverFarItCame) {
    FailingExecutor<Overflow> early, late;
    Replica one = replicaOn(early.lend()), other = replicaOn(late.lend()), intact(scene_);
    for (std::uint64_t number = 1; number <= 9; ++number) {
        if (number <= 3) {
            intact.apply(digging(number));
        }
        if (number == 4) {
            early.arm(0, 1);
            late.arm(3, 1);
        }
        sand::Step step = number == 4 ? changing(number) : digging(number);
        step.sweeps = number == 4 ? 4 : 0;  // the other four of eight would be owed
        one.apply(step);
        other.apply(step);
        ASSERT_EQ(one.leftOut(), number == 4 ? "skipped: too much sand" : "") << number;
        ASSERT_EQ(other.leftOut(), one.leftOut()) << number;
        ASSERT_EQ(one.stateHash(), other.stateHash()) << number;
        ASSERT_EQ(one.encodeState(), other.encodeState()) << number;
        if (number == 4) {
            EXPECT_EQ(one.stepNumber(), 4U);
            EXPECT_FALSE(one.canUndo());
            EXPECT_FALSE(one.engaged());
            EXPECT_EQ(one.owed(), sand::Owed());
            EXPECT_EQ(one.probe(), digging(3).path.back());
            EXPECT_EQ(one.heading(), scene_.rules.tuning.tool.heading);
            EXPECT_EQ(one.rules(), scene_.rules);
            for (int tile = 0; tile < one.hashTiles().tileCount(); ++tile) {
                EXPECT_EQ(one.surface().valuesOf(tile), intact.surface().valuesOf(tile)) << tile;
                EXPECT_EQ(other.surface().valuesOf(tile), intact.surface().valuesOf(tile)) << tile;
            }
        }
    }
    EXPECT_TRUE(early.thrown() && late.thrown());
    ASSERT_NE(intact.surface().valuesOf(0), Replica(scene_).surface().valuesOf(0)) << "the hand must move sand";
}

TEST_F(SkippedStep, RestoresTheSandOfTheSceneIfNoOtherIsKept) {
    FailingExecutor<Overflow> executor;
    Replica replica = replicaOn(executor.lend());
    executor.arm(3, 1);
    replica.apply({.epoch = 1, .number = 1, .engaged = false, .path = {{3000, 2000, 100}}});
    EXPECT_EQ(replica.leftOut(), "skipped: too much sand");
    for (int tile = 0; tile < replica.hashTiles().tileCount(); ++tile) {
        EXPECT_EQ(replica.surface().valuesOf(tile), Replica(scene_).surface().valuesOf(tile)) << tile;
    }
    replica.apply({.epoch = 1, .number = 2, .engaged = false, .path = {}, .edit = sand::Edit::reset});
    EXPECT_EQ(replica.leftOut(), "") << "the next step is applied";
    EXPECT_EQ(replica.stepNumber(), 2U);
}

TEST_F(SkippedStep, IsNotOneThatRunsOutOfMemory) {
    FailingExecutor<std::bad_alloc> executor;
    Replica replica = replicaOn(executor.lend());
    executor.arm(0, 1);
    EXPECT_THROW(replica.apply(digging(1)), std::bad_alloc) << "another replica has the memory";
}

}  // namespace
