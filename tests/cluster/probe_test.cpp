// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/x_server.hpp"

namespace {

/// What the programs find out about this machine without a job, and what the doctor makes of it.
class Probe : public SessionTest {
protected:
    /// A mono wall of two tiles, the second with this in its [[place]].
    std::string placedWall(const std::string& place) {
        const std::string file = wall(1, 2, "mono");
        std::ofstream(file, std::ios::app) << "[[place]]\ntiles = [\"r1c2\"]\n" << place << "\n";
        return file;
    }
    static support::Ran probe(const std::string& wallFile, const std::string& options) {
        return support::runCommand(fmt::format("env -u DISPLAY timeout 120 {}/sandwall-render-node --probe {} < {}",
                                               SANDWALL_BIN_DIR, options, wallFile));
    }
    support::Ran doctor(const std::string& wallFile) {
        return support::runCommand(fmt::format("env -u DISPLAY timeout 250 {}/scripts/sandwall doctor {} --out {}",
                                               SANDWALL_SOURCE_DIR, wallFile, folder_.string()));
    }
};

TEST_F(Probe, BothProgramsAreOfOneBuild) {
    const support::Ran master = support::runProgram("sandwall-master", "--build-id");
    const support::Ran node = support::runProgram("sandwall-render-node", "--build-id");
    EXPECT_EQ(master.status, 0);
    EXPECT_EQ(node.status, 0);
    EXPECT_EQ(master.output.size(), 17U) << master.output;
    EXPECT_EQ(master.output, node.output);
}

TEST_F(Probe, ARankWithoutAPlaceDrawsInMemory) {
    const std::string file = placedWall("windows = [[10, 20]]");
    for (const std::string rank : {"0", "1"}) {
        const support::Ran ran = probe(file, rank);
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_EQ(ran.output.rfind("osmesa: ", 0), 0U) << ran.output;
        EXPECT_NE(ran.output.find(", OpenGL "), std::string::npos) << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    }
}

TEST_F(Probe, WindowsThatAreNotAsWishedAreTold) {
    const support::XServer server(folder_, {"640x480x24"});
    const std::string display = "display = \"" + server.display() + "\"\n";
    const std::string inside = placedWall(display + "windows = [[10, 20]]");
    support::Ran ran = probe(inside, "2");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_EQ(ran.output.rfind("glfw: ", 0), 0U) << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    ran = doctor(inside);
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_NE(ran.output.find("rank 1: osmesa: "), std::string::npos) << ran.output;
    EXPECT_NE(ran.output.find("rank 2: glfw: "), std::string::npos) << ran.output;

    // 96 pixels wide at 600 of 640: 56 columns of 72 rows are nowhere.
    const std::string across = placedWall(display + "windows = [[600, 20]]");
    EXPECT_NE(probe(across, "2").output.find(" 4032 "), std::string::npos);
    ran = doctor(across);
    EXPECT_EQ(ran.status, 1) << ran.output;
    EXPECT_NE(ran.output.find(" 4032 "), std::string::npos) << ran.output;

    ran = probe(placedWall(display + "monitors = [\"nowhere\"]"), "2");
    expectOneLine({ran.status, ran.output}, "nowhere");
    EXPECT_NE(ran.output.find(server.display()), std::string::npos) << ran.output;
}

TEST_F(Probe, WhatCannotBeTriedIsOneLine) {
    const std::string file = placedWall("windows = [[10, 20]]");
    for (const auto& [options, named] :
         {std::pair{"3", "--probe"}, {"2", "--gl glfw"}, {"1 --gl cray", "'cray'"}, {"-1", "--probe"}}) {
        const support::Ran ran = probe(file, options);
        expectOneLine({ran.status, ran.output}, named);
    }
    const support::Ran ran = probe("/dev/null", "1");
    expectOneLine({ran.status, ran.output}, "standard input");
}

}  // namespace
