// SPDX-License-Identifier: Apache-2.0
#include "master/operator/dark_outputs.hpp"

#include <gtest/gtest.h>

namespace {

using base::MonitorState;
using master::DarkOutputs;
using States = std::vector<MonitorState>;

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

/// A wall of two tiles with two projectors each. Its ranks report the states of their monitors once a second.
class DarkOutputsTest : public testing::Test {
protected:
    DarkOutputsTest() {
        walls::Grid grid;
        grid.columns = 2;
        wall_.stereo = walls::Stereo::passive;
        wall_.tiles = walls::tilesOf(grid, wall_.stereo);
        wall_.tiles[1].outputs[1].monitor = "DP-2";
        dark_.emplace(wall_, std::vector<std::string>{"the master", "rank 1", "rank 2"});
    }
    /// Reports the states of the four outputs, one second after the last report.
    void report(const States& states) {
        std::vector<lockstep::Arrival> arrivals(3);
        for (std::size_t i = 0; i < states.size(); ++i) {
            arrivals[1 + i / 2].monitors.at(i % 2) = static_cast<std::uint8_t>(states[i]);
        }
        dark_->add(arrivals, now_ += kSecond);
    }

    static constexpr MonitorState kOn = MonitorState::on, kOff = MonitorState::off, kOther = MonitorState::otherSize;
    walls::Wall wall_;
    std::int64_t now_ = 1000 * kSecond;
    std::optional<DarkOutputs> dark_;
};

TEST_F(DarkOutputsTest, OfAWallWhoseMonitorsAreOnAreNone) {
    report({kOn, kOn, kOn, kOn});
    report({kOn, kOn, kOn, kOn});
    EXPECT_TRUE(dark_->ranks().empty());
    EXPECT_TRUE(dark_->names().empty());
    EXPECT_TRUE(dark_->history().empty());
}

TEST_F(DarkOutputsTest, AreNamedWhileTheyAreDarkAndKeptAfterwards) {
    report({kOn, kOn, kOn, kOn});
    report({kOn, kOn, kOn, kOff});
    EXPECT_EQ(dark_->ranks(), std::vector<std::uint32_t>{2});
    EXPECT_EQ(dark_->names(), std::vector<std::string>{"r1c2_right"});
    report({kOn, kOn, kOn, kOther});  // another reason, and still the same time
    report({kOn, kOn, kOn, kOn});
    EXPECT_TRUE(dark_->ranks().empty());
    report({kOn, kOn, kOn, kOff});
    ASSERT_EQ(dark_->history().size(), 1U);
    const master::DarkOutput once = dark_->history()[0];
    EXPECT_EQ(once.output, "r1c2_right");
    EXPECT_EQ(once.tile, "r1c2");
    EXPECT_EQ(once.rank, 2);
    EXPECT_EQ(once.monitor, "DP-2");
    EXPECT_EQ(once.times, 2U);
    EXPECT_DOUBLE_EQ(once.seconds, 2) << "from the second report to the fourth";
    EXPECT_TRUE(once.atEnd);
}

TEST_F(DarkOutputsTest, OfOneTileCountItsRankOnce) {
    report({kOff, kOff, kOn, kOff});
    EXPECT_EQ(dark_->ranks(), (std::vector<std::uint32_t>{1, 2}));
    EXPECT_EQ(dark_->names(), (std::vector<std::string>{"r1c1_left", "r1c1_right", "r1c2_right"}));
}

}  // namespace
