// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/hand.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/sand/sand_samples.hpp"

namespace {

using haptic_bridge::Hand;
using haptic_bridge::HandSample;
using sand::ProbePoint;

constexpr ProbePoint kToolPlace{20 * 256, 30 * 256, 0};

/// A hand that reads itself once for each step, one unit farther east each time.
class ReadHand : public Hand {
public:
    ReadHand() : Hand(60) {}
    using Hand::add;
    using Hand::last;

    bool reads = false;
    int readings = 0;

private:
    void collect() override {
        if (reads) {
            ++readings;
            add({1000 + readings, {readings, 0, 0}, true});
        }
    }
};

class HandTest : public testing::Test {
protected:
    /// Returns sand in which a tool was left at kToolPlace, or hovers there.
    [[nodiscard]] sand::Replica sandWithTool(bool engaged) const {
        sand::Replica sand(scene_);
        sand.apply({0, 1, engaged, {kToolPlace}});
        return sand;
    }
    [[nodiscard]] sand::Step next() {
        sand::Step step;
        readNs_ = hand_.fill(step);
        return step;
    }
    const scene::Scene scene_ = samples::flatScene(60, 60);
    ReadHand hand_;
    std::int64_t readNs_ = 0;
};

TEST_F(HandTest, FirstLiftsAToolThatWasLeftInTheSand) {
    hand_.begin(sandWithTool(true));
    EXPECT_EQ(hand_.last().probe, kToolPlace);
    hand_.add({7, {1, 2, 3}, true});
    const sand::Step lifts = next();
    EXPECT_FALSE(lifts.engaged);
    EXPECT_TRUE(lifts.path.empty());
    EXPECT_EQ(readNs_, 0);
    const sand::Step digs = next();
    EXPECT_TRUE(digs.engaged);
    EXPECT_EQ(digs.path, (std::vector<ProbePoint>{{1, 2, 3}}));
    EXPECT_EQ(readNs_, 7);
}

TEST_F(HandTest, ContinuesAtOnceWhereAToolHovers) {
    hand_.begin(sandWithTool(false));
    hand_.add({7, kToolPlace, false});
    EXPECT_TRUE(next().path.empty()) << "the tool is there already";
    hand_.add({8, kToolPlace, true});
    EXPECT_EQ(next().path, (std::vector<ProbePoint>{kToolPlace}));
    hand_.begin(sandWithTool(true));
    (void)next();
    hand_.add({9, kToolPlace, false});
    EXPECT_TRUE(next().path.empty()) << "begin() has restarted the path";
}

TEST_F(HandTest, HoversAndDropsSamplesWhileItIsNotPresent) {
    hand_.add({7, {1, 2, 3}, true});
    EXPECT_FALSE(hand_.present());
    EXPECT_EQ(next(), sand::Step{});
    hand_.begin(sandWithTool(false));
    EXPECT_TRUE(hand_.present());
    EXPECT_EQ(next(), sand::Step{});
    hand_.add({8, {1, 2, 3}, true});
    hand_.end();
    EXPECT_EQ(hand_.dropped(), 1U) << "the sample waited";
    EXPECT_EQ(next(), sand::Step{});
    hand_.begin(sandWithTool(false));
    EXPECT_EQ(next(), sand::Step{}) << "samples of the time before do not come later";
    EXPECT_EQ(hand_.dropped(), 1U);
}

TEST_F(HandTest, IsReadOnceForEachStepThatMoves) {
    hand_.reads = true;
    (void)next();
    hand_.begin(sandWithTool(true));
    (void)next();
    EXPECT_EQ(hand_.readings, 0) << "neither without a hand nor in the step that lifts";
    EXPECT_EQ(next().path, (std::vector<ProbePoint>{{1, 0, 0}}));
    EXPECT_EQ(next().path, (std::vector<ProbePoint>{{2, 0, 0}}));
    EXPECT_EQ(readNs_, 1002);
}

TEST_F(HandTest, GivesNoTimeForAPlaceThatWasNotRead) {
    hand_.begin(sandWithTool(false));
    hand_.add({.readNs = 7, .probe = {1, 2, 3}, .read = false});
    EXPECT_EQ(next().path, (std::vector<ProbePoint>{{1, 2, 3}}));
    EXPECT_EQ(readNs_, 0);
    hand_.add({8, {2, 2, 3}, false});
    hand_.add({.readNs = 9, .probe = {3, 2, 3}, .read = false});
    EXPECT_EQ(next().path.size(), 2U);
    EXPECT_EQ(readNs_, 8) << "that of the last place that was read";
}

}  // namespace
