// SPDX-License-Identifier: Apache-2.0
#include "tracking/tracked_viewer.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/tracking/tracking_samples.hpp"
#include "walls/projection.hpp"

namespace {

using namespace tracking;
using test::near;

/// Returns a wall with one screen of 2 m x 1 m in the plane z = 0, seen from 2 m away.
class TrackedViewerTest : public testing::Test {
protected:
    TrackedViewerTest() {
        wall_.viewer = {{0, 1.5, 2}, 0.06, {1, 0, 0}};
        walls::Tile tile;
        tile.name = "front";
        tile.screen = {{-1, 1, 0}, {1, 1, 0}, {-1, 2, 0}};
        wall_.tiles.push_back(tile);
        file_ = std::filesystem::temp_directory_path() / ("sandwall-head-" + std::to_string(getpid()) + ".csv");
    }
    ~TrackedViewerTest() override { std::filesystem::remove(file_); }

    TrackedViewer viewer(const std::string& trace) {
        std::ofstream(file_) << trace;
        return {wall_, Source::parse("trace:" + file_.string(), "--track"),
                [this](const std::string& line) { lines_.push_back(line); }};
    }

    walls::Wall wall_;
    std::filesystem::path file_;
    std::vector<std::string> lines_;
};

TEST_F(TrackedViewerTest, IsTheWallsOwnWithoutATracker) {
    TrackedViewer still(wall_, Source{}, [](const std::string&) {});
    EXPECT_FALSE(still.tracked());
    EXPECT_EQ(still.at(0), wall_.viewer);
    EXPECT_EQ(still.at(100), wall_.viewer);
    EXPECT_EQ(still.counters(), Counters{});
}

TEST_F(TrackedViewerTest, GoesWhereTheHeadGoesAndKeepsTheEyesApart) {
    TrackedViewer viewer = this->viewer("time,x,y,z,yaw,pitch,roll\n0,0,1.5,2,0,0,0\n1,0.4,1.7,1,30,0,0\n");
    EXPECT_TRUE(viewer.tracked());
    EXPECT_EQ(viewer.at(0), wall_.viewer);
    const walls::Viewer moved = viewer.at(1);
    EXPECT_TRUE(near(moved.eye, {0.4, 1.7, 1}));
    EXPECT_EQ(moved.eyeSeparation, 0.06);
    // The right eye is 3 cm from the middle, along (cos 30, 0, -sin 30).
    EXPECT_TRUE(near(walls::eyePosition(moved, walls::Eye::right), {0.4 + 0.03 * std::sqrt(0.75), 1.7, 0.985}));
    EXPECT_TRUE(lines_.empty());
}

TEST_F(TrackedViewerTest, HoldsAHeadThatWalksBehindAScreen) {
    TrackedViewer viewer = this->viewer("time,x,y,z\n0,0,1.5,1\n1,0,1.5,-1\n2,0,1.5,-1\n3,0,1.5,1\n9,0,1.5,1\n");
    for (int frame = 0; frame < 60 * 9; ++frame) {
        const walls::Viewer now = viewer.at(frame / 60.0);
        // Every rank can draw a picture for each viewer that at() returns.
        EXPECT_NO_THROW((void)walls::viewOf(wall_.tiles[0].screen, now.eye, 0.1, 100));
        EXPECT_GE(now.eye.z, TrackedViewer::kNearestEye);
        if (frame == 120) {
            EXPECT_NEAR(now.eye.z, 1.0 / 30, 1e-9) << "the last frame in front of it: 29/60 s at 2 m/s";
        }
        // The head is outside from frame 30 to 150. Its return is reported when it has been inside for more than 1 s.
        EXPECT_EQ(lines_.size(), frame < 30 ? 0 : frame <= 150 + 60 ? 1 : 2) << "frame " << frame;
    }
    ASSERT_EQ(lines_.size(), 2U);
    EXPECT_EQ(lines_[0],
              "head tracking: the head at (0.00, 1.50, 0.00) is not in front of tile 'front'; the last place is held");
    EXPECT_EQ(lines_[1], "head tracking: the head is in front of every tile again");
    // The head is at z = 0 at 0.5 s and again at 2.5 s. Both frames are outside.
    EXPECT_EQ(viewer.counters().outside, 121U);
}

TEST_F(TrackedViewerTest, LooksAtEachEye) {
    // The midpoint is in front of the screen. If the head turns sideways, one eye is behind the screen.
    TrackedViewer viewer = this->viewer("time,x,y,z,yaw,pitch,roll\n0,0,1.5,0.02,90,0,0\n");
    EXPECT_EQ(viewer.at(0), wall_.viewer);
    EXPECT_EQ(viewer.counters().outside, 1U);
}

TEST_F(TrackedViewerTest, StandsAtItsOwnPlaceUntilATrackerTells) {
    TrackedViewer viewer(wall_, Source::parse("opentrack:0", "--track"), [](const std::string&) {});
    EXPECT_EQ(viewer.at(0), wall_.viewer);
    EXPECT_NE(viewer.port(), 0);
}

}  // namespace
