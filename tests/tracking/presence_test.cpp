// SPDX-License-Identifier: Apache-2.0
#include "tracking/presence.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using tracking::Presence;

constexpr std::int64_t kMs = 1'000'000;

class PresenceTest : public testing::Test {
protected:
    std::vector<std::string> lines;
    Presence presence{"dtrack:5000", [this](const std::string& line) { lines.push_back(line); }};
};

TEST_F(PresenceTest, SaysOnceThatATrackerIsLostAndOnceThatItIsBack) {
    presence.look(true, 0);
    for (std::int64_t at = 0; at <= 2000; at += 10) {
        presence.look(false, at * kMs);
        EXPECT_EQ(presence.gone(), at > 500) << at;
    }
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0], "head tracking: no pose from dtrack:5000 for 0.5 s; the last one is held");
    presence.look(true, 2300 * kMs);
    presence.look(true, 2310 * kMs);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[1], "head tracking: dtrack:5000 is back after 2.3 s");
    EXPECT_EQ(presence.timesLost(), 1U);
}

TEST_F(PresenceTest, IsSilentWhilePosesCome) {
    for (std::int64_t at = 0; at < 10'000; at += 500) {
        presence.look(true, at * kMs);
    }
    EXPECT_TRUE(lines.empty());
    EXPECT_EQ(presence.timesLost(), 0U);
}

TEST_F(PresenceTest, AStalledFrameIsNoLostTracker) {
    // Packets that arrived during a frame of three seconds are read before a report.
    presence.look(true, 0);
    presence.look(true, 3000 * kMs);
    EXPECT_TRUE(lines.empty());
}

TEST_F(PresenceTest, SaysThatATrackerWasNeverThere) {
    for (std::int64_t at = 7000; at <= 9000; at += 10) {
        presence.look(false, at * kMs);
    }
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0], "head tracking: no pose from dtrack:5000 yet; the viewer stays where the wall file puts it");
    presence.look(true, 9010 * kMs);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[1], "head tracking: dtrack:5000 is there");
    EXPECT_EQ(presence.timesLost(), 0U) << "no pose has ever come";
}

TEST_F(PresenceTest, CountsEveryLoss) {
    presence.look(true, 0);
    for (std::int64_t i = 1; i <= 3; ++i) {
        presence.look(false, (2000 * i - 1) * kMs);
        presence.look(true, 2000 * i * kMs);
    }
    EXPECT_EQ(presence.timesLost(), 3U);
    EXPECT_EQ(lines.size(), 6U);
}

}  // namespace
