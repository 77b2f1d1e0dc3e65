// SPDX-License-Identifier: Apache-2.0
#include "master/steps/position_source.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using haptic_bridge::Position;

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// A server that streams positions, without a socket.
class Positions : public testing::Test {
protected:
    void SetUp() override { source_.begin(replica_); }
    void add(double x, double y, double z, bool engaged = true) {
        add(Position{clock_ += kMillisecond, x, y, z, engaged});
    }
    void add(const Position& position) { source_.add({{position, clock_}}, clock_); }
    sand::Step step() {
        sand::Step step;
        step.number = replica_.stepNumber() + 1;
        source_.fill(step);
        replica_.apply(step);
        return step;
    }
    std::string told() {
        std::string all;
        for (const std::string& line : source_.troubles(floods_, clock_)) {
            all += line + "\n";
        }
        return all;
    }
    const scene::Scene scene_ = samples::flatScene(64, 64);
    sand::Replica replica_{scene_};
    master::PositionSource source_{scene_, haptic_bridge::HandSettings::Datum::surface};
    std::int64_t clock_ = 20'000 * kMillisecond;
    std::uint64_t floods_ = 0;
};

TEST_F(Positions, MoveTheSandWhereTheHandIs) {
    add(0, 0, 0);
    EXPECT_TRUE(step().engaged);
    for (int i = 1; i <= 16; ++i) {
        add(0.02 * i, 0, 0);
    }
    EXPECT_EQ(step().path.size(), 16U);
    EXPECT_LT(samples::fieldOf(replica_).height(36, 32), 0);
    EXPECT_EQ(samples::fieldOf(replica_).height(10, 10), 0);
    EXPECT_EQ(told(), "");
}

TEST_F(Positions, AHandThatIsSilentIsLifted) {
    add(0, 0, 0);
    EXPECT_TRUE(step().engaged);
    clock_ += 400 * kMillisecond;
    source_.add({}, clock_);
    EXPECT_TRUE(step().engaged) << "a hand may rest";
    clock_ += 200 * kMillisecond;
    source_.add({}, clock_);
    EXPECT_FALSE(step().engaged);
    add(0.1, 0, 0);
    EXPECT_TRUE(step().engaged);
}

TEST_F(Positions, NonsenseLiftsTheToolAndIsTold) {
    add(0, 0, 0);
    (void)step();
    add(kNoNumber, 0, 0);
    EXPECT_FALSE(step().engaged);
    add(0, 0, kNoNumber);
    EXPECT_FALSE(step().engaged);
    EXPECT_EQ(told(),
              "haptic link: the server sends values that are not finite, 2 times so far; the tool is lifted and the "
              "hand feels nothing\n");
    add(0, 0, 0);
    EXPECT_TRUE(step().engaged) << "the hand continues";
    EXPECT_EQ(told(), "");
}

TEST_F(Positions, AJumpCutsNoFurrow) {
    add(-0.9, 0, 0);
    (void)step();
    add(0.9, 0, 0);
    EXPECT_FALSE(step().engaged);
    add(0.9, 0.01, 0);
    const sand::Step after = step();
    EXPECT_TRUE(after.engaged);
    EXPECT_EQ(samples::fieldOf(replica_).height(32, 32), 0) << "nothing in between was touched";
    EXPECT_LT(samples::fieldOf(replica_).height(60, 32), 0);
    EXPECT_NE(told().find("jumps, 1 times"), std::string::npos);
}

TEST_F(Positions, ATimeThatRunsBackwardsIsLeftOut) {
    add(0, 0, 0);
    (void)step();
    add(Position{clock_ - 5 * kMillisecond, 0.2, 0, 0, true});
    EXPECT_FALSE(step().engaged);
    EXPECT_NE(told().find("runs backwards in time, 1 readings"), std::string::npos);
}

TEST_F(Positions, AFloodIsTold) {
    floods_ = 3;
    EXPECT_EQ(told(),
              "haptic link: the server sends more than the master can take in, and was held back 3 times so far\n");
}

TEST_F(Positions, AToolLeftInTheSandIsLiftedFirst) {
    add(-0.5, 0, 0);
    (void)step();
    ASSERT_TRUE(replica_.engaged());
    source_.end();
    source_.begin(replica_);
    add(0.5, 0, 0);
    EXPECT_FALSE(step().engaged);
    EXPECT_TRUE(step().engaged);
    EXPECT_EQ(samples::fieldOf(replica_).height(32, 32), 0);
}

}  // namespace
