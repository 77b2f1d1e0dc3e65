// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/pointer_hand.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using haptic_bridge::PointerReport;

constexpr std::int64_t kReadingNs = 1'000'000;
constexpr std::int32_t kPerCell = sand::kProbePerCell;

/// Two ranks with pointers, over level sand at height 0. The tool has a radius of 4 cells.
class PointerHand : public testing::Test {
protected:
    /// Adds a place of rank `rank`'s pointer, in cells.
    void add(std::size_t rank, int x, int y, bool pressed, bool meets = true) {
        PointerReport& report = reports_.at(rank);
        haptic_bridge::PointerSample& sample = report.samples.at(report.count++);
        sample = {clock_ += kReadingNs,
                  {x * kPerCell, y * kPerCell, 0},
                  static_cast<std::uint8_t>(pressed ? 1 : 0),
                  static_cast<std::uint8_t>(meets ? 1 : 0),
                  {}};
        if (pressed && report.pressed == 0) {
            ++report.touch;
        }
        report.pressed = pressed ? 1 : 0;
    }
    /// Shows a frame with one step.
    sand::Step step() {
        hand_.take(reports_, depth_, replica_);
        for (PointerReport& report : reports_) {
            report.count = 0;
        }
        sand::Step step;
        step.number = replica_.stepNumber() + 1;
        read_ = hand_.fill(step);
        replica_.apply(step);
        return step;
    }
    [[nodiscard]] int height(int x, int y) const { return samples::fieldOf(replica_).height(x, y); }

    const scene::Scene scene_ = samples::flatScene(64, 64);
    sand::Replica replica_{scene_};
    haptic_bridge::PointerHand hand_{60, replica_};
    double depth_ = 0.5;  // [tool radius]
    std::array<PointerReport, 3> reports_{};
    std::int64_t clock_ = 20'000 * kReadingNs;
    std::int64_t read_ = 0;
};

TEST_F(PointerHand, DigsAFurrowAlongThePressedPlaces) {
    add(1, 20, 32, false);
    sand::Step hovers = step();
    EXPECT_FALSE(hovers.engaged);
    ASSERT_EQ(hovers.path.size(), 1U);
    EXPECT_EQ(hovers.path[0].z, std::lround(haptic_bridge::PointerHand::kHover * 4 * kPerCell));
    for (int x = 20; x <= 40; x += 4) {
        add(1, x, 32, true);
    }
    const sand::Step digs = step();
    EXPECT_TRUE(digs.engaged);
    EXPECT_EQ(digs.path.size(), 6U);
    EXPECT_EQ(digs.path[0].z, 2 * kPerCell) << "half of the tool is below the sand's surface, as it begins";
    EXPECT_EQ(read_, clock_) << "the time of the last place";
    EXPECT_LT(height(30, 32), 0);
    EXPECT_EQ(height(10, 10), 0);
}

TEST_F(PointerHand, ARestingToolHoversJustAboveTheSandInItsNewSize) {
    add(1, 20, 32, false);
    step();
    for (const int cells : {8, 2}) {
        sand::Tuning tuning = replica_.rules().tuning;
        tuning.tool.radius = cells * kPerCell;
        replica_.apply({0, replica_.stepNumber() + 1, false, {}, sand::Edit::tuned(tuning)});
        const sand::Step hovers = step();
        EXPECT_FALSE(hovers.engaged);
        ASSERT_EQ(hovers.path.size(), 1U);
        EXPECT_EQ(hovers.path[0].z, std::lround(haptic_bridge::PointerHand::kHover * cells * kPerCell));
        EXPECT_EQ(read_, 0) << "the pointer has not moved";
        EXPECT_TRUE(step().path.empty());
    }
}

TEST_F(PointerHand, DigsAsDeepAsItIsSet) {
    depth_ = 0.7;
    add(1, 20, 32, true);
    EXPECT_EQ(step().path.at(0).z, std::lround(0.3 * 4 * kPerCell));
    depth_ = 2;
    add(1, 24, 32, true);
    EXPECT_EQ(step().path.at(0).z, -4 * kPerCell);
}

TEST_F(PointerHand, BesideTheSandMovesNothing) {
    const std::int64_t before = [this] {
        add(1, 20, 32, false);
        (void)step();
        return samples::fieldOf(replica_).volume();
    }();
    add(1, 0, 0, true, false);
    const sand::Step aside = step();
    EXPECT_FALSE(aside.engaged);
    EXPECT_TRUE(aside.path.empty());
    EXPECT_EQ(height(0, 0), 0);
    EXPECT_EQ(samples::fieldOf(replica_).volume(), before);
}

TEST_F(PointerHand, AStrokeThatLeavesTheSandLiftsAndComesBackElsewhere) {
    add(1, 20, 32, true);
    (void)step();
    add(1, 0, 0, true, false);
    EXPECT_FALSE(step().engaged);
    add(1, 44, 32, true);
    EXPECT_TRUE(step().engaged);
    EXPECT_EQ(height(32, 32), 0) << "no furrow from the old place to the new one";
    EXPECT_LT(height(44, 32), 0);
}

TEST_F(PointerHand, ASecondPointerWaitsForTheFirst) {
    add(1, 20, 20, true);
    (void)step();
    add(2, 44, 44, true);
    EXPECT_TRUE(step().path.empty()) << "the first pointer rests";
    EXPECT_EQ(height(44, 44), 0);
    add(1, 20, 20, false);
    add(2, 45, 44, true);
    EXPECT_FALSE(step().engaged) << "the tool is lifted on the way";
    EXPECT_TRUE(step().engaged);
    EXPECT_LT(height(45, 44), 0);
    EXPECT_EQ(height(32, 32), 0);
}

TEST_F(PointerHand, IsLiftedWhenTheNextPointerRests) {
    add(1, 20, 20, true);
    (void)step();
    add(2, 44, 44, true);
    (void)step();
    add(1, 20, 20, false);
    EXPECT_FALSE(step().engaged) << "the second pointer is pressed, but has not moved since";
    EXPECT_EQ(read_, clock_) << "the time of the release";
    add(2, 45, 44, true);
    EXPECT_TRUE(step().engaged);
    EXPECT_LT(height(45, 44), 0);
    EXPECT_EQ(height(32, 32), 0) << "no furrow from the first pointer to the second one";
}

TEST_F(PointerHand, StaysWithinTheReachOfAStep) {
    depth_ = 2;
    add(1, 20, 32, true);
    reports_[1].samples[0].probe.z = -sand::kMaxProbe;
    hand_.take(reports_, depth_, replica_);
    sand::Step deep;
    (void)hand_.fill(deep);
    EXPECT_EQ(deep.path.at(0).z, -sand::kMaxProbe);
}

}  // namespace
