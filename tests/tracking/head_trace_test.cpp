// SPDX-License-Identifier: Apache-2.0
#include "tracking/head_trace.hpp"

#include <sstream>

#include "tests/support/files/text_forms.hpp"
#include "tests/support/refusal.hpp"
#include "tests/tracking/tracking_samples.hpp"

namespace {

using namespace tracking;
using test::near;

HeadTrace parse(const std::string& text, const RoomMapping& mapping = {}) {
    std::istringstream stream(text);
    return HeadTrace::parse(stream, "head.csv", mapping);
}

std::string refusal(const std::string& text, const RoomMapping& mapping = {}) {
    return test::refusalOf([&] { (void)parse(text, mapping); });
}

TEST(HeadTrace, GoesStraightFromSampleToSample) {
    const HeadTrace trace = parse("time,x,y,z\n10,0,1.6,2\n11,1,1.6,2\n13,1,2.0,4\n");
    EXPECT_EQ(trace.duration(), 3);
    EXPECT_EQ(trace.at(0).position, glm::dvec3(0, 1.6, 2));
    EXPECT_TRUE(near(trace.at(0.25).position, {0.25, 1.6, 2}));
    EXPECT_EQ(trace.at(1).position, glm::dvec3(1, 1.6, 2));
    EXPECT_TRUE(near(trace.at(2).position, {1, 1.8, 3}));
    EXPECT_EQ(trace.at(2).right, glm::dvec3(1, 0, 0));
}

TEST(HeadTrace, HoldsItsEnds) {
    const HeadTrace trace = parse("time,x,y,z\n0,0,0,1\n1,1,0,1\n");
    EXPECT_EQ(trace.at(-5).position, glm::dvec3(0, 0, 1));
    EXPECT_EQ(trace.at(1).position, glm::dvec3(1, 0, 1));
    EXPECT_EQ(trace.at(1e9).position, glm::dvec3(1, 0, 1));
    EXPECT_EQ(parse("time,x,y,z\n4,1,2,3\n").at(7).position, glm::dvec3(1, 2, 3)) << "one sample stands still";
}

TEST(HeadTrace, JumpsWhereTwoSamplesHaveOneTime) {
    const HeadTrace trace = parse("time,x,y,z\n0,0,0,0\n1,1,0,0\n1,5,0,0\n2,6,0,0\n");
    EXPECT_TRUE(near(trace.at(0.5).position, {0.5, 0, 0}));
    EXPECT_EQ(trace.at(1).position, glm::dvec3(5, 0, 0));
    EXPECT_TRUE(near(trace.at(1.5).position, {5.5, 0, 0}));
}

TEST(HeadTrace, GivesTheSamePoseForTheSameFrameInAnyOrder) {
    std::string text = "time,x,y,z,yaw,pitch,roll\n";
    for (int i = 0; i < 50; ++i) {
        text +=
            std::to_string(i * 0.037) + "," + std::to_string(std::sin(i)) + ",1.6,2," + std::to_string(i) + ",0,0\n";
    }
    const HeadTrace trace = parse(text), again = parse(text);
    std::vector<Pose> forth;
    forth.reserve(120);
    for (int frame = 0; frame < 120; ++frame) {
        forth.push_back(trace.at(frame / 60.0));
    }
    for (int frame = 119; frame >= 0; --frame) {
        EXPECT_EQ(again.at(frame / 60.0), forth[static_cast<std::size_t>(frame)]) << frame;
    }
}

TEST(HeadTrace, UnderstandsEveryWayToTellATurn) {
    const glm::dvec3 left(std::sqrt(0.75), 0, -0.5);  // turned by 30 degrees
    EXPECT_TRUE(near(parse("time,x,y,z,yaw,pitch,roll\n0,0,0,0,30,0,0\n").at(0).right, left));
    // A turn by 30 degrees about y has the quaternion of cos 15° and sin 15°.
    EXPECT_TRUE(near(parse("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,0.9659258263,0,0.2588190451,0\n").at(0).right, left, 1e-9));
    EXPECT_TRUE(
        near(parse("right_z,right_y,right_x,time,z,y,x\n-0.5,0,0.8660254038,0,0,0,0\n").at(0).right, left, 1e-9));
}

TEST(HeadTrace, TurnsOnTheShorterWayAndStaysAUnit) {
    const HeadTrace trace = parse("time,x,y,z,yaw,pitch,roll\n0,0,0,0,0,0,0\n1,0,0,0,60,0,0\n2,0,0,0,240,0,0\n");
    EXPECT_TRUE(near(trace.at(0.5).right, {std::sqrt(0.75), 0, -0.5})) << "half of 60 degrees";
    for (int i = 0; i < 200; ++i) {
        const double time = i * 0.01;
        EXPECT_NEAR(glm::length(trace.at(time).right), 1, 1e-12) << time;
    }
}

TEST(HeadTrace, IsPutIntoTheRoom) {
    const RoomMapping mapping{{0, 0, 1}, axesOf("x,z,-y").value(), {}};
    const HeadTrace trace = parse("time,x,y,z,right_x,right_y,right_z\n0,1,2,3,0,1,0\n", mapping);
    EXPECT_TRUE(near(trace.at(0).position, {1, 3, -1}));
    EXPECT_TRUE(near(trace.at(0).right, {0, 0, -1})) << "its y runs into the wall";
}

TEST(HeadTrace, NamesFileLineAndValue) {
    EXPECT_EQ(refusal("time,x,y,z\n0,0,0,0\n1,abc,0,0\n"), "head.csv:3: x is not a number: 'abc'");
    EXPECT_EQ(refusal("time,x,y,z\n0,0,nan,0\n"), "head.csv:2: y is not a number: 'nan'");
    EXPECT_EQ(refusal("time,x,y,z\n0,0,0\n"), "head.csv:2: 4 values expected, got 3");
    EXPECT_EQ(refusal("time,x,y,z\n0,0,0,0,0\n"), "head.csv:2: 4 values expected, got 5");
    EXPECT_EQ(refusal("time,x,y,z\n\n0,0,0,0\n\n-1,0,0,0\n"), "head.csv:5: time runs backwards: -1 after 0");
    EXPECT_EQ(refusal("time,x,y,z\n0,0,1650,0\n"), "head.csv:2: y is in metres and at most 100, got 1650");
    EXPECT_EQ(refusal("time,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,0\n"),
              "head.csv:2: the quaternion must have length 1, got 0");
    EXPECT_EQ(refusal("time,x,y,z,right_x,right_y,right_z\n0,0,0,0,2,0,0\n"),
              "head.csv:2: right_x,right_y,right_z must have length 1, got 2");
}

TEST(HeadTrace, IsReadInEveryFormOfText) {
    for (const test::TextForm& form : test::formsOf("time,x,y,z\n+10,0,1.5,2\n12,1,1.5,2\n")) {
        const HeadTrace trace = parse(form.bytes);
        EXPECT_EQ(trace.duration(), 2) << form.name;
        EXPECT_EQ(trace.at(1).position, glm::dvec3(0.5, 1.5, 2)) << form.name;
    }
    EXPECT_EQ(parse("time;x;y;z\n10;0;1,5;2\n12;1;1,5;2\n").at(1).position, glm::dvec3(0.5, 1.5, 2));
    EXPECT_EQ(parse("time\tx\ty\tz\n10\t0\t1.5\t2\n12\t1\t1.5\t2\n").at(1).position, glm::dvec3(0.5, 1.5, 2));
    EXPECT_TRUE(refusal("time;x;y;z\n0;0;1,5;2\n1;1.5;0;2\n").starts_with("head.csv:3: '1,5' in line 2"));
}

TEST(HeadTrace, NamesWhatIsWrongWithTheColumns) {
    EXPECT_EQ(refusal(""), "head.csv:1: the trace is empty; a header such as time,x,y,z comes first");
    EXPECT_EQ(refusal("time,x,y,z\n"), "head.csv:1: the trace holds no sample; lines of numbers follow the header");
    EXPECT_EQ(refusal("time,x,y\n0,0,0\n"), "head.csv:1: column 'z' is missing");
    EXPECT_EQ(refusal("time,x,y,z,yaw,roll\n0,0,0,0,0,0\n"), "head.csv:1: column 'pitch' is missing");
    EXPECT_EQ(refusal("time,x,y,z,z\n0,0,0,0,0\n"), "head.csv:1: column 'z' is there twice");
    EXPECT_EQ(refusal("time,x,y,z,jaw\n0,0,0,0,0\n").find("head.csv:1: column 'jaw' is not known"), 0U);
    EXPECT_EQ(refusal("time,x,y,z,yaw,pitch,roll,qx,qy,qz,qw\n0,0,0,0,0,0,0,0,0,0,1\n"),
              "head.csv:1: several groups of columns give the head's turn; keep one group");
    EXPECT_NE(refusal("time,x,y,z,right_x,right_y,right_z\n0,0,0,0,1,0,0\n", {{}, glm::dmat3(1.0), {0, 0.1, 0}})
                  .find("eyes= needs"),
              std::string::npos);
    EXPECT_EQ(test::refusalOf([] { (void)HeadTrace::load("/nowhere/head.csv", {}); }),
              "/nowhere/head.csv: the head's trace cannot be read; check the path");
    EXPECT_NE(test::refusalOf([] { (void)HeadTrace::load("/", {}); }).find("cannot be read"), std::string::npos);
}

}  // namespace
