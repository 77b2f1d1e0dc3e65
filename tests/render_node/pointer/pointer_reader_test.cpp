// SPDX-License-Identifier: Apache-2.0
#include "render_node/pointer/pointer_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "walls/projection.hpp"

namespace render_node {
namespace {

using Kind = PointerEvent::Kind;
using haptic_bridge::PointerReport;
using haptic_bridge::PointerSample;

constexpr int kCells = 64;
constexpr double kProbe = sand::kProbePerCell;

/// Returns level sand like samples::flatScene(), as a TIN of 8 x 8 squares.
scene::Scene levelTin() {
    scene::Scene scene = samples::flatScene(kCells, kCells);
    sand::tin::TinStart start;
    constexpr int kSide = kCells * sand::kProbePerCell;
    start.width = start.depth = kSide;
    start.places = {{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}};
    for (int y = 0; y <= 8; ++y) {
        for (int x = 0; x <= 8; ++x) {
            if ((x % 8 != 0) || (y % 8 != 0)) {  // the corners are there
                start.places.push_back({x * 8 * sand::kProbePerCell, y * 8 * sand::kProbePerCell});
            }
        }
    }
    start.heights.assign(start.places.size(), 4 * sand::kUnitsPerCell);
    scene.rules.tin = start.digest();
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    return scene;
}

/// A window of 640 x 640 pixels, 64 m wide, that looks straight down at 64 x 64 cells of 1 m from 1000 km. So ten
/// pixels are one cell, wherever the sand is high.
class Reader : public testing::Test {
protected:
    Reader() : Reader(samples::flatScene(kCells, kCells)) {}
    explicit Reader(scene::Scene scene) : scene_(std::move(scene)), sand_(scene_) {
        walls::Grid grid;
        grid.tileSize = {kCells, kCells};
        grid.tilePixels = {640, 640};
        wall_.grid = grid;
        wall_.tiles = walls::tilesOf(grid, walls::Stereo::mono);
        view_.head = {32, 32, 1e6};
        // The scene's z is the room's, and so are x and y: the screen is the level plane at height 0.
        (void)sand_.takeChange();
    }
    PointerReport read(std::vector<PointerEvent> events) {
        return reader_.read(events, sand_, view_, {-20, 20}, kAhead);
    }
    /// Applies a step that digs with the tool's centre at these places.
    void dig(std::vector<sand::ProbePoint> path, bool engaged = true) {
        sand::Step step;
        step.number = sand_.stepNumber() + 1;
        step.engaged = engaged;
        step.path = std::move(path);
        sand_.apply(step);
    }
    static sand::ProbePoint at(double x, double y, double z) {
        return {static_cast<int>(x * kProbe), static_cast<int>(y * kProbe), static_cast<int>(z * kProbe)};
    }
    static void expectAt(const PointerSample& sample, double x, double y) {
        EXPECT_EQ(sample.meets, 1);
        EXPECT_NEAR(sample.probe.x / kProbe, x, 0.02);
        EXPECT_NEAR(sample.probe.y / kProbe, y, 0.02);
    }

    static constexpr std::int64_t kAhead = 500;
    scene::Scene scene_;
    walls::Wall wall_;
    lockstep::ViewState view_;
    sand::Replica sand_;
    PointerReader reader_{wall_, 1};
};

TEST_F(Reader, ReportsThePlaceOfTheSandUnderEachMotion) {
    const PointerReport report = read({{Kind::move, 0, {200, 480}, 1500, 0}, {Kind::move, 0, {300, 480}, 1600, 0}});
    ASSERT_EQ(report.count, 2);
    expectAt(report.samples[0], 20, 16);
    expectAt(report.samples[1], 30, 16);
    EXPECT_EQ(report.samples[0].probe.z, 0);
    EXPECT_EQ(report.samples[0].readNs, 1000) << "on the master's clock";
    EXPECT_EQ(report.pressed, 0);
    EXPECT_FALSE(report.touches());
    EXPECT_EQ(read({}).count, 0) << "a pointer at rest";
}

TEST_F(Reader, BesideTheSandItMeetsNothing) {
    const PointerReport report = read({{Kind::move, 0, {-10, 480}, 1, 0}, {Kind::move, 0, {10, 480}, 2, 0}});
    ASSERT_EQ(report.count, 2);
    EXPECT_EQ(report.samples[0].meets, 0);
    EXPECT_EQ(report.samples[1].meets, 1);
}

TEST_F(Reader, CountsTouchesAlsoThoseBetweenTwoFrames) {
    const PointerReport tap = read(
        {{Kind::move, 0, {200, 480}, 1, 0}, {Kind::press, 0, {200, 480}, 2, 0}, {Kind::release, 0, {200, 480}, 3, 0}});
    ASSERT_EQ(tap.count, 3);
    EXPECT_EQ(tap.samples[1].pressed, 1);
    EXPECT_EQ(tap.samples[2].pressed, 0);
    EXPECT_TRUE(tap.touches());
    EXPECT_EQ(tap.pressed, 0);
    EXPECT_EQ(tap.touch, 1U);
    const PointerReport next = read({{Kind::press, 0, {200, 480}, 4, 0}});
    EXPECT_EQ(next.touch, 2U);
    EXPECT_EQ(next.pressed, 1);
    EXPECT_EQ(read({}).pressed, 1) << "it is still held";
}

TEST_F(Reader, OfManyMotionsItKeepsThePressTheReleaseAndTheLast) {
    std::vector<PointerEvent> events;
    for (int i = 0; i < 100; ++i) {
        const Kind kind = i == 40 ? Kind::press : i == 41 ? Kind::release : Kind::move;
        events.push_back({kind, 0, {100 + i, 480}, 1000 + i, 0});
    }
    const PointerReport report = read(events);
    ASSERT_EQ(report.count, PointerReport::kMostSamples);
    const auto samples = report.taken();
    EXPECT_EQ(std::ranges::count_if(samples, [](const PointerSample& sample) { return sample.pressed != 0; }), 1);
    expectAt(report.samples.back(), 19.9, 16);
    EXPECT_TRUE(std::ranges::is_sorted(samples, {}, &PointerSample::readNs));
}

TEST_F(Reader, FillsALongMotionOfAStrokeWithPlacesBetween) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    (void)read({{Kind::press, 0, {100, 480}, 1000, 0}});
    const PointerReport report = read({{Kind::move, 0, {180, 480}, 5 * kSecond, 0}});
    ASSERT_EQ(report.count, PointerReport::kMostSamples);
    EXPECT_LT(report.samples.back().readNs - report.samples[0].readNs, kSecond / 100) << "it has rested before";
    EXPECT_TRUE(std::ranges::is_sorted(report.taken(), {}, &PointerSample::readNs));
    for (std::size_t i = 0; i < report.count; ++i) {
        EXPECT_EQ(report.samples[i].pressed, 1);
        if (i > 0) {
            EXPECT_NEAR(report.samples[i].probe.x - report.samples[i - 1].probe.x, 1.5 * kProbe, 0.6 * kProbe);
        }
    }
    expectAt(report.samples.back(), 18, 16);
    EXPECT_EQ(read({{Kind::move, 0, {183, 480}, 6 * kSecond, 0}}).count, 1) << "a short one";
    (void)read({{Kind::release, 0, {183, 480}, 6 * kSecond + 1, 0}});
    EXPECT_EQ(read({{Kind::move, 0, {400, 480}, 6 * kSecond + 2, 0}}).count, 1) << "a hovering one";
}

TEST_F(Reader, TheRightButtonTurnsTheViewAndMovesNoTool) {
    const PointerReport report = read({{Kind::move, 0, {100, 100}, 1, 0},
                                       {Kind::turnPress, 0, {100, 100}, 2, 0},
                                       {Kind::move, 0, {164, 68}, 3, 0},
                                       {Kind::viewRelease, 0, {164, 68}, 4, 0},
                                       {Kind::move, 0, {200, 100}, 5, 0}});
    EXPECT_FLOAT_EQ(report.turnX, 0.1F);
    EXPECT_FLOAT_EQ(report.turnY, -0.05F);
    EXPECT_EQ(report.count, 2) << "before and after";
}

TEST_F(Reader, TheWheelCountsAndReportsThePlaceAgain) {
    const PointerReport report = read({{Kind::move, 0, {200, 480}, 1, 0}, {Kind::wheel, 0, {200, 480}, 2, 1.5}});
    EXPECT_FLOAT_EQ(report.wheel, 1.5F);
    EXPECT_EQ(report.depth, 0);
    EXPECT_EQ(report.count, 2);
    const PointerReport shifted = read({{Kind::wheel, 0, {200, 480}, 3, -1, true}});
    EXPECT_EQ(shifted.wheel, 0);
    EXPECT_FLOAT_EQ(shifted.depth, -1);
}

// The scene's coordinates are the room's.
TEST_F(Reader, TheWheelReportsThePointOfTheRoomUnderThePointer) {
    dig({at(20, 16, 0)});
    (void)sand_.takeChange();
    const PointerReport report = read({{Kind::wheel, 0, {200, 480}, 2, 1}});
    EXPECT_NEAR(report.wheelAt[0], 20, 0.02);
    EXPECT_NEAR(report.wheelAt[1], 16, 0.02);
    const double height = sand_.surface().height(20 * kProbe, 16 * kProbe) / sand::kUnitsPerCell;
    EXPECT_LT(height, -0.5) << "the tool has dug there";
    EXPECT_NEAR(report.wheelAt[2], height, 0.2) << "a float of 1e6 m in the line of sight";
    wall_.stage.centre.z = 7;
    const PointerReport beside = read({{Kind::wheel, 0, {-200, 480}, 2, 1}});
    EXPECT_NEAR(beside.wheelAt[0], -20, 0.02);
    EXPECT_NEAR(beside.wheelAt[2], 7, 0.1) << "beside the sand";
}

TEST_F(Reader, APanReportsHowFarThePointUnderThePointerMoved) {
    const PointerReport report = read({{Kind::move, 0, {100, 100}, 1, 0},
                                       {Kind::panPress, 0, {100, 100}, 2, 0},
                                       {Kind::move, 0, {130, 90}, 3, 0},
                                       {Kind::move, 0, {164, 68}, 4, 0}});
    EXPECT_NEAR(report.pan[0], 6.4, 1e-3);
    EXPECT_NEAR(report.pan[1], 3.2, 1e-3);
    EXPECT_NEAR(report.pan[2], 0, 1e-3);
    EXPECT_EQ(report.turnX, 0);
    EXPECT_EQ(report.count, 1) << "before";
    const PointerReport next = read(
        {{Kind::move, 0, {174, 68}, 5, 0}, {Kind::viewRelease, 0, {174, 68}, 6, 0}, {Kind::move, 0, {300, 68}, 7, 0}});
    EXPECT_NEAR(next.pan[0], 1, 1e-3) << "from where the last report ended";
    EXPECT_EQ(next.count, 1) << "after";
    EXPECT_EQ(read({{Kind::move, 0, {400, 68}, 8, 0}}).pan[0], 0) << "the button is up";
}

// A screen halfway between the eye and the sand: a pixel is twice as wide at the sand as on the screen.
TEST_F(Reader, APanIsMeasuredAtTheDepthOfTheSandUnderThePointer) {
    view_.head = {32, 32, 100};
    for (walls::Tile& tile : wall_.tiles) {
        for (glm::dvec3* corner : {&tile.screen.lowerLeft, &tile.screen.lowerRight, &tile.screen.upperLeft}) {
            corner->z = 50;
        }
    }
    const PointerReport report = read({{Kind::panPress, 0, {320, 320}, 2, 0}, {Kind::move, 0, {330, 320}, 3, 0}});
    EXPECT_NEAR(report.pan[0], 2, 1e-3);
}

TEST_F(Reader, TheWheelWithShiftOrControlIsAnotherOne) {
    const PointerReport report = read({{Kind::wheel, 0, {200, 480}, 1, 1, true, false},
                                       {Kind::wheel, 0, {200, 480}, 2, -2, false, true},
                                       {Kind::wheel, 0, {200, 480}, 3, 4, true, false}});
    EXPECT_EQ(report.wheel, 0);
    EXPECT_EQ(report.depth, 5);
    EXPECT_EQ(report.size, -2);
}

TEST_F(Reader, AStrokeRefersToTheSandFromBeforeIt) {
    EXPECT_EQ(read({{Kind::press, 0, {320, 320}, 1, 0}}).samples[0].probe.z, 0);
    dig({at(30, 32, 1), at(32, 32, 1), at(34, 32, 1)});
    EXPECT_EQ(read({{Kind::move, 0, {321, 320}, 2, 0}}).samples[0].probe.z, 0)
        << "the tool would sink into its own furrow";
    dig({}, false);
    EXPECT_LT(read({{Kind::release, 0, {321, 320}, 3, 0}}).samples[0].probe.z, -0.5 * kProbe) << "the furrow";
}

/// The window of Reader over a TIN, whose kept sand is encoded.
class TinReader : public Reader {
protected:
    TinReader() : Reader(levelTin()) {}
};

TEST_F(TinReader, AStrokeRefersToTheSandFromBeforeIt) {
    const std::int32_t before = read({{Kind::press, 0, {320, 320}, 1, 0}}).samples[0].probe.z;
    const double high = before / kProbe;
    dig({at(30, 32, high + 1), at(32, 32, high + 1), at(34, 32, high + 1)});
    EXPECT_EQ(read({{Kind::move, 0, {320, 320}, 2, 0}}).samples[0].probe.z, before);
    EXPECT_LT(read({{Kind::release, 0, {320, 320}, 3, 0}}).samples[0].probe.z, before - 0.5 * kProbe);
}

}  // namespace
}  // namespace render_node
