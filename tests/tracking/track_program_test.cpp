// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/processes/run_program.hpp"
#include "tracking/head_trace.hpp"
#include "tracking/udp_tracker.hpp"

namespace {

using namespace tracking;

support::Ran track(const std::string& arguments) { return support::runProgram("sandwall-track", arguments); }

TEST(SandwallTrack, SendsWhatATrackerOfThisKindReads) {
    for (const std::string kind : {"opentrack", "dtrack"}) {
        const auto tracker = openTracker(Source::parse(kind + ":0", "test"), glm::dvec3(0), [](const std::string&) {});
        const support::Ran ran =
            track("--send " + kind + ":" + std::to_string(tracker->port()) + " --rate 100 --seconds 0.1");
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_EQ(ran.output, "sandwall-track: 11 packets sent\n");
        const std::optional<Pose> pose = tracker->newest(0);
        ASSERT_TRUE(pose) << kind;
        EXPECT_GT(pose->position.x, 0) << "it sways to the right first";
        EXPECT_EQ(tracker->counters().packets, 11U);
        EXPECT_EQ(tracker->counters().refused, 0U);
    }
}

TEST(SandwallTrack, SendsATraceFromTheRoomAsSeenByTheTracker) {
    const auto file = std::filesystem::temp_directory_path() / ("sandwall-track-" + std::to_string(getpid()) + ".csv");
    std::ofstream(file) << "time,x,y,z\n0,0,1.6,2\n0.05,0.5,1.6,2\n";
    const auto tracker =
        openTracker(Source::parse("opentrack:0 origin=0,1,0", "test"), glm::dvec3(0), [](const std::string&) {});
    const support::Ran ran = track("--send \"opentrack:" + std::to_string(tracker->port()) +
                                   " origin=0,1,0\" --rate 100 --trace " + file.string());
    EXPECT_EQ(ran.status, 0) << ran.output;
    const std::optional<Pose> pose = tracker->newest(0);
    std::filesystem::remove(file);
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->position.x, 0.5, 1e-9) << "where the trace ends";
    EXPECT_NEAR(pose->position.y, 1.6, 1e-9);
}

TEST(SandwallTrack, PrintsATrace) {
    const auto file = std::filesystem::temp_directory_path() / ("sandwall-print-" + std::to_string(getpid()) + ".csv");
    std::ofstream(file) << "time,x,y,z,yaw,pitch,roll\n0,0,1.6,2,0,0,0\n0.1,0.5,1.6,2,30,0,0\n";
    const support::Ran ran = track("--listen \"trace:" + file.string() + " origin=1,0,0\" --rate 100 --seconds 0.2");
    std::filesystem::remove(file);
    EXPECT_EQ(ran.status, 0) << ran.output;
    std::istringstream text(ran.output.substr(0, ran.output.find("sandwall-track: ")));
    const HeadTrace printed = HeadTrace::parse(text, "printed", {});
    EXPECT_EQ(printed.at(0).position, glm::dvec3(1, 1.6, 2));
    EXPECT_EQ(printed.at(9).position, glm::dvec3(1.5, 1.6, 2));
    EXPECT_NEAR(printed.at(9).right.z, -0.5, 1e-5);
}

TEST(SandwallTrack, SaysInOneLineWhatItCannotDo) {
    for (const char* arguments :
         {"", "--send opentrack:1 --listen none", "--listen none", "--send none", "--send opentrack:0",
          "--listen opentrack:70000", "--send \"dtrack:1 axes=x,z,-y\"", "--listen opentrack:0 --trace x",
          "--listen opentrack:0 --seconds 0", "--send opentrack:1 --trace /nowhere.csv", "--listen vrpn:Head@host"}) {
        const support::Ran ran = track(arguments);
        EXPECT_EQ(ran.status, 2) << arguments << ": " << ran.output;
        EXPECT_EQ(ran.output.find('\n'), ran.output.size() - 1) << arguments << ": " << ran.output;
    }
}

}  // namespace
