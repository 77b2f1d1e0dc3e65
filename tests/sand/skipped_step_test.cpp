// SPDX-License-Identifier: Apache-2.0
// A step that the sand cannot take. No state and no step are known that make a surface throw, so these surfaces do.
#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <stdexcept>

#include "sand/grid/surface.hpp"
#include "sand/replica.hpp"
#include "tests/support/sand_samples.hpp"

namespace {

using sand::Replica;

/// Sand of a height field whose sweeps throw a Failure after they have changed the sand, from sweep call `from` on.
template <class Failure>
class FailingSurface : public sand::grid::GridSurface {
public:
    FailingSurface(const scene::Scene& scene, int from)
        : GridSurface(scene.rules, scene.terrain, scene.ground, {}), left_(from) {}
    void sweep(int sweeps, const sand::HeldTool* tool, const sand::ProbePoint& at) override {
        GridSurface::sweep(sweeps, tool, at);
        if (--left_ < 0) {
            throw Failure();
        }
    }

private:
    int left_;
};

struct Overflow : std::overflow_error {
    Overflow() : std::overflow_error("too much sand") {}
};

class SkippedStep : public testing::Test {
protected:
    template <class Failure>
    [[nodiscard]] Replica failingFrom(int step) const {
        return Replica(scene_, std::make_unique<FailingSurface<Failure>>(scene_, step));
    }
    /// Returns step `number` of a hand that digs from step 1 to 2, lifts in step 3 and digs again from step 4 on.
    static sand::Step digging(std::uint64_t number) {
        const auto x = static_cast<std::int32_t>(2000 + 300 * number);
        return {.epoch = 1, .number = number, .engaged = number != 3, .path = {{x, 2000, -100}}};
    }

    const scene::Scene scene_ = samples::flatScene(24, 16);
};

TEST_F(SkippedStep, CountsAndRestoresTheSandOfBeforeTheStrokeInEveryReplica) {
    Replica one = failingFrom<Overflow>(4), other = failingFrom<Overflow>(4), intact(scene_);
    for (std::uint64_t number = 1; number <= 5; ++number) {
        if (number <= 3) {
            intact.apply(digging(number));
        }
        one.apply(digging(number));
        other.apply(digging(number));
        ASSERT_EQ(one.stateHash(), other.stateHash()) << number;
        ASSERT_EQ(one.leftOut(), number == 5 ? "skipped: too much sand" : "") << number;
    }
    EXPECT_EQ(one.stepNumber(), 5U);
    ASSERT_NE(intact.surface().valuesOf(0), Replica(scene_).surface().valuesOf(0)) << "the hand must move sand";
    for (int tile = 0; tile < one.hashTiles().tileCount(); ++tile) {
        EXPECT_EQ(one.surface().valuesOf(tile), intact.surface().valuesOf(tile)) << tile;
    }
    EXPECT_FALSE(one.canUndo());
}

TEST_F(SkippedStep, RestoresTheSandOfTheSceneIfNoOtherIsKept) {
    Replica replica = failingFrom<Overflow>(0);
    replica.apply({.epoch = 1, .number = 1, .engaged = false, .path = {{3000, 2000, 100}}});
    EXPECT_EQ(replica.leftOut(), "skipped: too much sand");
    EXPECT_EQ(replica.volume(), 0);
    replica.apply({.epoch = 1, .number = 2, .engaged = false, .path = {}, .edit = sand::Edit::reset});
    EXPECT_EQ(replica.leftOut(), "") << "a reset runs no sweeps";
    EXPECT_EQ(replica.stepNumber(), 2U);
}

TEST_F(SkippedStep, IsNotOneThatRunsOutOfMemory) {
    Replica replica = failingFrom<std::bad_alloc>(0);
    EXPECT_THROW(replica.apply(digging(1)), std::bad_alloc) << "another replica has the memory";
}

}  // namespace
