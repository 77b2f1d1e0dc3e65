// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "base/input_error.hpp"
#include "haptic_bridge/devices/strokes.hpp"
#include "haptic_bridge/devices/trace.hpp"
#include "haptic_bridge/hand/hand_mapping.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/hand/jittery_trace.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;

constexpr double kField = 2.0, kRadius = 0.04;

Trace traceOf(const std::string& text, const std::vector<std::string>& map = {}) {
    std::istringstream stream(text);
    return Trace::parse(stream, "hand.csv", HandSettings::parse(map));
}

TraceDevice deviceOf(const std::string& text, const std::vector<std::string>& map = {}) {
    return {traceOf(text, map), HandSettings::parse(map), kField, kField, kRadius};
}

TEST(Trace, NamesTheLineOfWhatItCannotRead) {
    const auto starts = [](const std::string& text, const std::string& start) {
        const std::string message = test::refusalOf([&] { (void)traceOf(text); });
        EXPECT_EQ(message.substr(0, start.size()), start) << message;
    };
    starts("", "hand.csv:1: the trace is empty");
    starts("time,x,y\n0,1,2\n", "hand.csv:1: no column 'z'");
    starts("time,x,y,z\n0,1,2,3\n0.1,1,2\n", "hand.csv:3: 4 values expected, got 3");
    starts("time,x,y,z\n0,1,2,3\n0.1,1,2,3z\n", "hand.csv:3: z is not a number: '3z'");
    starts("time,x,y,z\n0,1,2,3\n0.1,nan,2,3\n", "hand.csv:3: x is not a number: 'nan'");
    starts("time,x,y,z\n0,1,2,3\n\n0.1,1e300,2,3\n", "hand.csv:4: x is not a number");
    starts("time,x,y,z\n0.5,1,2,3\n0.1,1,2,3\n", "hand.csv:3: time runs backwards: '0.1'");
    starts("time,x,y,z\nnoon,1,2,3\n", "hand.csv:2: time is neither");
    starts("time,x,y,z\n2023/02/30/10:00:00.0,1,2,3\n", "hand.csv:2: time is neither");
    starts("time,x,y,z\n0,1,2,3\n", "hand.csv:2: a trace needs at least two samples, got 1");
}

TEST(Trace, ReadsDatesAcrossMidnight) {
    const Trace trace =
        traceOf("time,x,y,z\r\n2023/12/31/23:59:59.990000,0,0,0\r\n2024/01/01/00:00:00.002500,1,0,0\r\n");
    ASSERT_EQ(trace.samples.size(), 2U);
    EXPECT_NEAR(trace.samples[1].time, 0.0125, 1e-6);
}

TEST(Trace, FindsItsColumnsByNameAndItsUnitOfTime) {
    const Trace trace = traceOf("note,up,t,e,n\na,3,10,1,2\nb,6,12,4,5\n", {"columns=t,e,n,up", "time=ms"});
    EXPECT_NEAR(trace.samples[1].time, 0.002, 1e-12);
    EXPECT_EQ(trace.samples[1].place, (std::array<double, 3>{4, 5, 6}));
}

TEST(TraceDevice, FitsFourFifthsOfTheFieldAndDigsHalfARadius) {
    TraceDevice device = deviceOf("time,x,y,z\n0,0,0,7\n1,100,0,7\n2,100,50,7\n");
    const Pose start = device.read(0), corner = device.read(2);
    EXPECT_NEAR(start.x, -0.8, 1e-12);
    EXPECT_NEAR(start.y, -0.4, 1e-12);
    EXPECT_NEAR(corner.x, 0.8, 1e-12);
    EXPECT_NEAR(corner.y, 0.4, 1e-12);
    EXPECT_NEAR(start.z, 0.5, 1e-12) << "the underside is half a radius below the surface";
    EXPECT_TRUE(start.engaged);
}

TEST(TraceDevice, TurnsAxesScalesAndMovesTheOrigin) {
    TraceDevice device = deviceOf("time,x,y,z\n0,10,20,30\n1,10,20,30\n",
                                  {"axes=x,-z,y", "scale=0.01", "origin=0,0,20", "depth=1", "vertical=2"});
    const Pose pose = device.read(0.5);
    EXPECT_NEAR(pose.x, 0.1, 1e-12);
    EXPECT_NEAR(pose.y, -0.3, 1e-12);
    EXPECT_NEAR(pose.z, 0.0, 1e-12);
}

TEST(TraceDevice, EngagesNearTheSandOrAlways) {
    const std::string lifted = "time,x,y,z\n0,0,0,0\n1,0,0,0\n2,0,0,0\n3,0,0,1\n4,0,0,1\n";
    TraceDevice near = deviceOf(lifted, {"scale=1"}), always = deviceOf(lifted, {"scale=1", "engage=always"});
    EXPECT_TRUE(near.read(1).engaged);
    EXPECT_FALSE(near.read(3.5).engaged) << "25 radii above the sand";
    EXPECT_TRUE(always.read(3.5).engaged);
    const Pose over = always.read(9);
    EXPECT_TRUE(always.finished(9));
    EXPECT_FALSE(over.engaged) << "a finished recording hovers";
    EXPECT_EQ(over.z, always.read(10).z);
}

TEST(TraceDevice, BridgesGapsByTime) {
    // A hand at constant speed was recorded with jitter and gaps. Read every millisecond, it still moves evenly.
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    const std::string text = test::jitteryTrace(seed, 2.0, [](double t) {
        return std::array<double, 3>{100 * t, 0, 0};
    });
    TraceDevice device = deviceOf(text, {"scale=0.01", "origin=0,0,0"});
    const double end = traceOf(text).samples.back().time;
    for (double time = 0; time < end; time += 1e-3) {
        ASSERT_NEAR(device.read(time).x, time, 1e-6) << "at " << time;
    }
}

TEST(HandSettings, NamesTheOptionItCannotRead) {
    for (const char* wrong :
         {"scale",           "scale=0",       "scale=x",        "axes=x,y",     "axes=x,x,z",   "axes=x,y,q",
          "time=h",          "columns=a,b,c", "columns=a,,c,d", "origin=1,2",   "engage=maybe", "datum=sea",
          "tilt=3",          "scale=nan",     "scale=inf",      "vertical=nan", "vertical=inf", "origin=0,nan,0",
          "origin=0,0,-inf", "depth=nan",     "depth=inf",      "drift=nan",    "drift=inf"}) {
        const std::string message = test::refusalOf([&] { (void)HandSettings::parse({wrong}); });
        EXPECT_EQ(message.find(std::string("--map ") + wrong + ":"), 0U) << message;
    }
}

TEST(Strokes, NamesTheLineOfWhatItCannotRead) {
    const auto starts = [](const std::string& text, const std::string& start) {
        const std::string message = test::refusalOf([&] { (void)Strokes::parse(text, "word"); });
        EXPECT_EQ(message.substr(0, start.size()), start) << message;
    };
    starts("", "word:1: no stroke");
    starts("# nothing\npoint 1 2\n", "word:2: 'point' before the first 'stroke'");
    starts("stroke\npoint 1\n", "word:2: 'point' takes X Y, got 1 values");
    starts("stroke\npoint 1 two\n", "word:2: 'point' needs a number");
    starts("stroke\n\nstroke\npoint 0 0\n", "word:3: the stroke before this line has no points");
    starts("speed 0\n", "word:1: 'speed' needs a number");
    starts("stroke\nline 0 0\n", "word:2: 'line' is unknown; write stroke");
    starts("stroke\narc 0 0 1 1 0\n", "word:2: 'arc' takes");
    for (const std::string number : {"nan", "inf", "-inf"}) {
        for (const std::string word : {"speed", "depth", "travel", "lift", "heading"}) {
            starts(fmt::format("{} {}", word, number), fmt::format("word:1: '{}' needs a number from ", word));
        }
        starts("stroke\npoint 0 0\nhold " + number, "word:3: 'hold' needs a number from ");
        starts("stroke\npoint 0 " + number, "word:2: 'point' needs a number from ");
        for (const std::string arc :
             {"? 0 1 1 0 90", "0 ? 1 1 0 90", "0 0 ? 1 0 90", "0 0 1 ? 0 90", "0 0 1 1 ? 90", "0 0 1 1 0 ?"}) {
            std::string values = arc;
            starts("stroke\narc " + values.replace(arc.find('?'), 1, number), "word:2: 'arc' needs a number from ");
        }
    }
}

TEST(StrokeDevice, DrawsAtItsSpeedLiftsBetweenAndHoversAtTheEnd) {
    StrokeDevice device(
        Strokes::parse("speed 2\ntravel 4\ndepth 0.25\nlift 3\nstroke\npoint 0 0\npoint 1 0\n"
                       "stroke\npoint 1 1\npoint 0 1\n",
                       "word"));
    EXPECT_NEAR(device.duration(), 0.5 + 0.25 + 0.5, 1e-12);
    const Pose drawing = device.read(0.25);
    EXPECT_TRUE(drawing.engaged);
    EXPECT_NEAR(drawing.x, 0.5, 1e-12);
    EXPECT_NEAR(drawing.z, 0.75, 1e-12);
    const Pose lifted = device.read(0.6);
    EXPECT_FALSE(lifted.engaged);
    EXPECT_NEAR(lifted.y, 0.4, 1e-12);
    EXPECT_NEAR(lifted.z, 4, 1e-12);
    EXPECT_TRUE(device.finished(1.25));
    const Pose over = device.read(100);
    EXPECT_FALSE(over.engaged);
    EXPECT_NEAR(over.x, 0, 1e-12);
    EXPECT_NEAR(over.y, 1, 1e-12);
}

TEST(StrokeDevice, TurnsItsToolAsTheFileSaysAndHoldsAStamp) {
    StrokeDevice device(
        Strokes::parse("speed 1\ntravel 1\nstroke\npoint 0 0\npoint 1 0\nheading 30\nfoot left\nstroke\npoint 1 1\n"
                       "hold 0.5\nfollow\nfoot right\nstroke\npoint 1 1\npoint 1 2\npoint 0 2\n",
                       "walk"));
    EXPECT_FALSE(device.read(0.5).heading.has_value()) << "the tool has not been turned yet";
    EXPECT_EQ(device.read(1.5).heading, 30) << "in the air the tool turns for the next stroke";
    const Pose stamp = device.read(2.3);
    EXPECT_TRUE(stamp.engaged);
    EXPECT_TRUE(stamp.leftFoot);
    EXPECT_NEAR(device.read(3.0).heading.value_or(0), 90, 1e-9);
    EXPECT_NEAR(std::abs(device.read(4.0).heading.value_or(0)), 180, 1e-9) << "after the corner";
    EXPECT_FALSE(device.read(4.0).leftFoot);
    EXPECT_DOUBLE_EQ(device.duration(), 4.5);
}

TEST(HandMapping, TakesNoHeadingFromAHandThatGivesNoneOrNoNumber) {
    EXPECT_FALSE(HandMapping::heading({}).has_value());
    for (const double bad : {std::nan(""), HUGE_VAL}) {
        EXPECT_FALSE(HandMapping::heading({0, 0, 0, true, bad}).has_value());
    }
    EXPECT_EQ(HandMapping::heading({0, 0, 0, true, 90, true}), (sand::Heading{0, sand::Heading::kLength, true}));
}

TEST(StrokeDevice, WritesGisInLessThanFourSeconds) {
    const Strokes gis = Strokes::parse(gisStrokes(), "gis.strokes");
    EXPECT_EQ(gis.strokes.size(), 3U);
    EXPECT_LE(StrokeDevice(gis).duration(), 3.8);
    for (const auto& stroke : gis.strokes) {
        for (const auto& point : stroke.points) {
            EXPECT_LE(std::abs(point.x), 0.9);
            EXPECT_LE(std::abs(point.y), 0.61);
        }
    }
}

scene::Scene wideScene() {
    scene::Scene scene;
    scene.terrain = sand::HeightField(200, 100, 0.01);
    scene.rules.columns = 200;
    scene.rules.rows = 100;
    scene.rules.tuning.tool.radius = 4 * sand::kProbePerCell;
    for (int row = 0; row < 100; ++row) {
        for (int column = 0; column < 200; ++column) {
            scene.terrain.setHeight(column, row, column < 100 ? 0 : 10 * sand::kUnitsPerCell);
        }
    }
    return scene;
}

TEST(HandMapping, CountsHalfTheShorterSideFromTheCentre) {
    const scene::Scene scene = wideScene();
    const HandMapping mapping(scene, HandSettings::Datum::level);
    const auto at = [&](double x, double y, double z) { return *mapping.probe({x, y, z, true}); };
    EXPECT_EQ(at(0, 0, 0), (sand::ProbePoint{100 * 256, 50 * 256, 5 * 256})) << "the mean height is 5 cells";
    EXPECT_EQ(at(1, 1, 1), (sand::ProbePoint{150 * 256, 100 * 256, 9 * 256}));
    EXPECT_EQ(at(-2, -1, -1), (sand::ProbePoint{0, 0, 256}));
    EXPECT_NEAR(sand::force::placeOf(at(1, 1, 1), sand::probeUnit(0.01)).x, 1.5, 1e-12);
}

TEST(HandMapping, FollowsTheStartingSurface) {
    const scene::Scene scene = wideScene();
    const HandMapping mapping(scene, HandSettings::Datum::surface);
    EXPECT_EQ(mapping.probe({-1, 0, 0.5, true})->z, 2 * 256);
    EXPECT_EQ(mapping.probe({1, 0, 0.5, true})->z, 12 * 256);
    EXPECT_EQ(mapping.probe({50, 0, 0, true})->z, 10 * 256) << "beyond the field the height of the rim counts";
}

TEST(HandMapping, ClampsWhatIsOutOfReachAndDropsWhatIsNoNumber) {
    const scene::Scene scene = wideScene();
    const HandMapping mapping(scene, HandSettings::Datum::surface);
    const auto far = mapping.probe({1e30, -1e30, 1e30, true});
    ASSERT_TRUE(far);
    EXPECT_LE(far->x, sand::kMaxProbe);
    EXPECT_GE(far->y, -sand::kMaxProbe);
    for (const double noNumber : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        EXPECT_FALSE(mapping.probe({noNumber, 0, 0, true}));
        EXPECT_FALSE(mapping.probe({0, noNumber, 0, true}));
        EXPECT_FALSE(mapping.probe({0, 0, noNumber, true}));
    }
}

}  // namespace
