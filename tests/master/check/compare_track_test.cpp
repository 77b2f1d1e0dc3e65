// SPDX-License-Identifier: Apache-2.0
#include "master/check/compare_track.hpp"

#include <gtest/gtest.h>

namespace {

using master::CompareTrack;

// Ten tiles, three in each frame: frames 1 to 4 hash all of them, so that what was wrong in frame 1 is found by frame
// 4. Frames 2 to 5 hash twelve, and so on.
TEST(CompareTrack, HasComparedWholeWhatWasWrongWhenTheRoundBegan) {
    CompareTrack track(10);
    for (std::uint64_t frame = 1; frame <= 3; ++frame) {
        track.agreed(frame, 3);
        EXPECT_EQ(track.lastWhole(), 0U) << frame;
    }
    for (std::uint64_t frame = 4; frame <= 40; ++frame) {
        track.agreed(frame, 3);
        EXPECT_EQ(track.lastWhole(), frame - 3) << "hashed in four frames";
    }
    track.agreed(41, 10);
    EXPECT_EQ(track.lastWhole(), 41U) << "one frame has hashed every tile";
    track.agreed(42, 1);
    EXPECT_EQ(track.lastWhole(), 41U);
    track.agreed(43, 9);
    EXPECT_EQ(track.lastWhole(), 42U);
}

TEST(CompareTrack, KeepsTheFirstDifferenceOfTheSession) {
    CompareTrack track(4);
    EXPECT_EQ(track.firstDifference(), 0U);
    track.differed(7);
    track.differed(9);
    EXPECT_EQ(track.firstDifference(), 7U);
    CompareTrack resumed(4, 7);
    resumed.differed(100);
    EXPECT_EQ(resumed.firstDifference(), 7U) << "it was before the restart";
}

}  // namespace
