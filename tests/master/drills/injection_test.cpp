// SPDX-License-Identifier: Apache-2.0
#include "master/drills/injection.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "base/input_error.hpp"

namespace {

using lockstep::Fault;
constexpr master::FaultTargets kWall{12, 200, 100, true};

TEST(Injection, OfSlowDrawingIsForTheRestOfTheSessionOrForSomeFrames) {
    EXPECT_EQ(master::parseFault("slow:rank=5,ms=30", kWall),
              (Fault{.kind = Fault::Kind::slow,
                     .rank = 5,
                     .frame = 1,
                     .frames = std::numeric_limits<std::uint64_t>::max(),
                     .milliseconds = 30}));
    EXPECT_EQ(master::parseFault("slow:frames=10,ms=7,rank=12,frame=100", kWall),
              (Fault{.kind = Fault::Kind::slow, .rank = 12, .frame = 100, .frames = 10, .milliseconds = 7}));
}

TEST(Injection, KnowsEveryKindOfFault) {
    EXPECT_EQ(master::parseFault("diverge:rank=0,frame=9", kWall),
              (Fault{.kind = Fault::Kind::diverge, .rank = 0, .frame = 9}));
    EXPECT_EQ(master::parseFault("diverge:rank=3,frame=9,column=199,row=99,bit=20", kWall),
              (Fault{.kind = Fault::Kind::diverge, .rank = 3, .frame = 9, .column = 199, .row = 99, .bit = 20}));
    EXPECT_EQ(master::parseFault("movement:rank=0,frame=9,column=199,row=99", kWall),
              (Fault{.kind = Fault::Kind::movement, .rank = 0, .frame = 9, .column = 199, .row = 99}));
    EXPECT_EQ(master::parseFault("die:rank=0,frame=9", kWall),
              (Fault{.kind = Fault::Kind::die, .rank = 0, .frame = 9, .signal = 9}));
    EXPECT_EQ(master::parseFault("die:rank=12,frame=9,signal=11", kWall),
              (Fault{.kind = Fault::Kind::die, .rank = 12, .frame = 9, .signal = 11}));
    EXPECT_EQ(master::parseFault("hang:rank=2,frame=9", kWall),
              (Fault{.kind = Fault::Kind::hang, .rank = 2, .frame = 9}));
    EXPECT_EQ(master::parseFault("garbage:rank=2,frame=9", kWall),
              (Fault{.kind = Fault::Kind::garbage, .rank = 2, .frame = 9}));
    EXPECT_EQ(master::parseFault("partition:rank=2,frame=9,ms=60000", kWall),
              (Fault{.kind = Fault::Kind::partition, .rank = 2, .frame = 9, .milliseconds = 60000}));
    EXPECT_EQ(master::parseFault("view:rank=2,frame=9", kWall),
              (Fault{.kind = Fault::Kind::view, .rank = 2, .frame = 9}));
    EXPECT_EQ(master::parseFault("shader:rank=2", kWall), (Fault{.kind = Fault::Kind::shader, .rank = 2, .frame = 0}));
}

TEST(Injection, WithoutARankStrikesTheHapticLink) {
    EXPECT_EQ(master::parseFault("garbage:frame=9", kWall).rank, Fault::kLink);
    EXPECT_EQ(master::parseFault("partition:ms=500,frame=9", kWall).rank, Fault::kLink);
}

TEST(Injection, ThatCannotBeIsNamedInOneLine) {
    for (const auto& [text, part] : {std::pair{"", "no such fault; write slow:rank=R,ms=MS"},
                                     {"slow", "no such fault"},
                                     {"burn:rank=5", "no such fault"},
                                     {"slow:", "rank is missing"},
                                     {"slow:rank=5", "ms is missing"},
                                     {"slow:rank=13,ms=30", "rank must be 1 to 12, got '13'"},
                                     {"slow:rank=0,ms=30", "rank must be 1 to 12, got '0'"},
                                     {"slow:rank=-1,ms=30", "rank must be 1 to 12, got '-1'"},
                                     {"slow:rank=5,ms=1e9", "ms must be 1 to 10000, got '1e9'"},
                                     {"slow:rank=5,ms=99999999999999999999", "ms must be 1 to 10000"},
                                     {"slow:rank=5,ms=", "ms must be 1 to 10000, got ''"},
                                     {"slow:rank=5,ms=30,frame=0", "frame must be a whole number from 1"},
                                     {"slow:rank=5,ms=30,rank=6", "'rank=6' is not understood"},
                                     {"slow:rank=5,ms=30,tile=6", "'tile=6' is not understood"},
                                     {"slow:rank=5;ms=30", "rank must be 1 to 12, got '5;ms=30'"},
                                     {"die:rank=13,frame=1", "rank must be 0 to 12, got '13'"},
                                     {"die:rank=1", "frame is missing; write die:rank=R,frame=F[,signal=S]"},
                                     {"die:rank=1,frame=1,signal=17", "signal 17 ends no process; write one that does"},
                                     {"die:rank=1,frame=1,signal=0", "signal must be 1 to 31, got '0'"},
                                     {"hang:frame=1", "rank is missing"},
                                     {"hang:rank=1,frame=1,ms=3", "'ms=3' is not understood"},
                                     {"diverge:rank=1,frame=1,column=200", "column must be 0 to 199, got '200'"},
                                     {"diverge:rank=1,frame=1,row=100", "row must be 0 to 99, got '100'"},
                                     {"diverge:rank=1,frame=1,bit=28", "bit must be 0 to 27, got '28'"},
                                     {"movement:rank=1,frame=1,row=100", "row must be 0 to 99, got '100'"},
                                     {"movement:rank=1,frame=1,bit=2", "'bit=2' is not understood"},
                                     {"garbage:rank=0,frame=1", "rank must be 1 to 12, got '0'"},
                                     {"partition:frame=1", "ms is missing"}}) {
        try {
            (void)master::parseFault(text, kWall);
            ADD_FAILURE() << text << " was accepted";
        } catch (const base::InputError& error) {
            const std::string said = error.what();
            EXPECT_NE(said.find(part), std::string::npos) << said;
            EXPECT_EQ(said.find("--inject " + std::string(text) + ": "), 0U) << said;
            EXPECT_EQ(said.find('\n'), std::string::npos) << said;
        }
    }
}

TEST(Injection, OfMovementNeedsAGrid) {
    master::FaultTargets tin = kWall;
    tin.movement = false;
    try {
        (void)master::parseFault("movement:rank=1,frame=9", tin);
        ADD_FAILURE() << "was accepted";
    } catch (const base::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("take a scene with a grid"), std::string::npos) << error.what();
    }
}

TEST(Injection, OfTheLinkNeedsALink) {
    master::FaultTargets alone = kWall;
    alone.link = false;
    for (const char* text : {"garbage:frame=9", "partition:ms=500,frame=9"}) {
        try {
            (void)master::parseFault(text, alone);
            ADD_FAILURE() << text << " was accepted";
        } catch (const base::InputError& error) {
            EXPECT_NE(std::string(error.what()).find("add rank=R"), std::string::npos) << error.what();
        }
    }
    EXPECT_EQ(master::parseFault("garbage:rank=1,frame=9", alone).rank, 1);
}

}  // namespace
