// SPDX-License-Identifier: Apache-2.0
// Recorded hands and stroke lists as other programs save them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "haptic_bridge/devices/strokes.hpp"
#include "haptic_bridge/devices/trace.hpp"
#include "tests/support/files/text_forms.hpp"
#include "tests/support/refusal.hpp"

namespace {

using namespace haptic_bridge;

Trace handOf(const std::string& text, const std::vector<std::string>& map = {}) {
    std::istringstream stream(text);
    return Trace::parse(stream, "hand.csv", HandSettings::parse(map));
}

std::string handRefusal(const std::string& text, const std::vector<std::string>& map = {}) {
    return test::refusalOf([&] { (void)handOf(text, map); });
}

/// Two samples: at 0 s at (0.5, -1, 2), and half a second later at (1.25, -1, 2).
const std::string kHand = "time,x,y,z\n7,0.5,-1,2\n7.5,1.25,-1,2\n";

void expectTheHand(const Trace& trace, std::string_view form) {
    ASSERT_EQ(trace.samples.size(), 2U) << form;
    EXPECT_EQ(trace.samples[0].place, (std::array<double, 3>{0.5, -1, 2})) << form;
    EXPECT_EQ(trace.samples[1].place, (std::array<double, 3>{1.25, -1, 2})) << form;
    EXPECT_EQ(trace.samples[1].time, 0.5) << form;
}

TEST(TraceText, IsReadInEveryForm) {
    for (const test::TextForm& form : test::formsOf(kHand)) {
        expectTheHand(handOf(form.bytes), form.name);
    }
}

TEST(TraceText, MayHaveOtherSeparatorsAndDecimalCommas) {
    for (const char separator : {';', '\t'}) {
        std::string points = kHand;
        std::replace(points.begin(), points.end(), ',', separator);
        expectTheHand(handOf(points), "decimal points");
        std::replace(points.begin(), points.end(), '.', ',');
        expectTheHand(handOf(points), "decimal commas");
    }
    expectTheHand(handOf("\"time\",\"x\",\"y\",\"z\"\n+7,+0.5,-1,2\n7.5,1.25,-1,2\n"), "quoted titles, a plus sign");
    EXPECT_NE(handRefusal("time;x;y;z\n0;1,5;0;0\n1;1.500,5;0;0\n").find("hand.csv:3: x is not a number: '1.500,5'"),
              std::string::npos);
    EXPECT_NE(handRefusal("time;x;y;z\n0;1,500;0;0\n1;2.5;0;0\n").find("hand.csv:3: '1,500' in line 2"),
              std::string::npos)
        << "the comma could separate thousands";
}

TEST(TraceText, TimesMayCountFrom1970InAnyUnit) {
    // Two samples 10 ms apart. A double cannot hold the last three digits of nanoseconds since 1970, so that the
    // difference would be 10.000128 ms with doubles alone.
    const auto elapsed = [](const std::string& first, const std::string& second, const std::string& unit) {
        return handOf("time,x,y,z\n" + first + ",0,0,0\n" + second + ",1,0,0\n", {"time=" + unit}).samples[1].time;
    };
    EXPECT_DOUBLE_EQ(elapsed("1693934358000", "1693934358010", "ms"), 0.01);
    EXPECT_DOUBLE_EQ(elapsed("1693934358000000", "1693934358010000", "us"), 0.01);
    EXPECT_DOUBLE_EQ(elapsed("1693934358000000123", "1693934358010000123", "ns"), 0.01);
    EXPECT_NEAR(elapsed("1693934358.25", "1693934358.26", "s"), 0.01, 1e-15);
    EXPECT_DOUBLE_EQ(elapsed("1.693934358e9", "1.69393436e9", "s"), 2);
    EXPECT_DOUBLE_EQ(elapsed("-2.5", "-2.25", "s"), 0.25);
}

TEST(TraceText, TimesThatCannotBeSecondsAskForTheirUnit) {
    EXPECT_EQ(
        handRefusal("time,x,y,z\n1693934358000,0,0,0\n1693934358010,1,0,0\n"),
        "hand.csv:2: time '1693934358000' would be thousands of years after 1970; give its unit: --map time=ms, us "
        "or ns");
    EXPECT_EQ(handRefusal("time,x,y,z\n0,0,0,0\n1693934358,1,0,0\n"),
              "hand.csv:3: time jumps: '1693934358' is more than 30 years after the first sample");
    EXPECT_EQ(handRefusal("time,x,y,z\n1e999,0,0,0\n1,1,0,0\n"),
              "hand.csv:2: time is neither a number nor YYYY/MM/DD/HH:MM:SS.ffffff: '1e999'");
}

TEST(StrokesText, IsReadInEveryForm) {
    for (const test::TextForm& form : test::formsOf("speed +2\n# a line\nstroke\npoint -0.5 +0.25\npoint 1 0\n")) {
        const Strokes strokes = Strokes::parse(form.bytes, "s");
        ASSERT_EQ(strokes.strokes.size(), 1U) << form.name;
        EXPECT_EQ(strokes.strokes[0].speed, 2) << form.name;
        ASSERT_EQ(strokes.strokes[0].points.size(), 2U) << form.name;
        EXPECT_EQ(strokes.strokes[0].points[0].x, -0.5) << form.name;
        EXPECT_EQ(strokes.strokes[0].points[0].y, 0.25) << form.name;
    }
    EXPECT_TRUE(test::refusalOf([] {
                    (void)Strokes::parse(std::string_view("stroke\npoint 0 0\n\0point 1 0\n", 28), "s");
                }).starts_with("s:3: a byte 0 is inside the text"));
}

}  // namespace
