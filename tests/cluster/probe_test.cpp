// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/not_yet_error.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/run_program.hpp"
#include "tests/support/screens/x_server.hpp"

namespace {

/// Checks of this machine that need no MPI job: by the programs, and by the doctor.
class Probe : public SessionTest {
protected:
    /// Returns a mono wall file of two tiles. The second tile has `place` in its [[place]].
    std::string placedWall(const std::string& place) {
        std::string file = wall(1, 2, "mono");
        std::ofstream(file, std::ios::app) << "[[place]]\ntiles = [\"r1c2\"]\n" << place << "\n";
        return file;
    }
    struct Json {
        int status;
        nlohmann::json found;
    };
    static Json probeJson(const std::string& wallFile, const std::string& options) {
        const support::Ran ran = probe(wallFile, options + " --json");
        EXPECT_EQ(ran.status, 0) << ran.output;
        return {ran.status, nlohmann::json::parse(ran.output)};
    }
    static support::Ran probe(const std::string& wallFile, const std::string& options) {
        return support::runCommand(fmt::format("env -u DISPLAY timeout 120 {}/sandwall-render-node --probe {} < {}",
                                               SANDWALL_BIN_DIR, options, wallFile));
    }
    /// `variable` is NAME=VALUE, or empty.
    Json doctor(const std::string& wallFile, const std::string& variable = "") {
        const support::Ran ran = support::runCommand(
            fmt::format("env -u DISPLAY {} timeout 250 {}/scripts/sandwall doctor {} --json --out {}", variable,
                        SANDWALL_SOURCE_DIR, wallFile, folder_.string()));
        return {ran.status, nlohmann::json::parse(ran.output)};
    }
    /// Returns the finding of the doctor for one check on one rank, or null if the doctor has no such finding.
    static nlohmann::json finding(const Json& ran, const std::string& check, int rank) {
        for (const nlohmann::json& one : ran.found["findings"]) {
            if (one["check"] == check && one["ranks"] == nlohmann::json{rank}) {
                return one;
            }
        }
        return nullptr;
    }
};

TEST_F(Probe, TakesItsOptionsInAnyOrder) {
    const std::string file = placedWall("windows = [[10, 20]]");
    for (const char* options :
         {"--probe 1 --gl osmesa --json", "--gl osmesa --json --probe 1", "--json --probe=1 --gl=osmesa"}) {
        const support::Ran ran = support::runCommand(
            fmt::format("env -u DISPLAY timeout 120 {}/sandwall-render-node {} < {}", SANDWALL_BIN_DIR, options, file));
        EXPECT_EQ(ran.status, 0) << options << ": " << ran.output;
        EXPECT_NE(ran.output.find("\"backend\":\"osmesa\""), std::string::npos) << options << ": " << ran.output;
    }
}

TEST_F(Probe, ARankWithoutAPlaceDrawsInMemory) {
    const std::string file = placedWall("windows = [[10, 20]]");
    for (const std::string rank : {"0", "1"}) {
        const Json ran = probeJson(file, rank);
        EXPECT_EQ(ran.found["backend"], "osmesa");
        EXPECT_NE(ran.found["renderer"], "");
        EXPECT_TRUE(ran.found["shortcomings"].empty()) << ran.found;
    }
}

TEST_F(Probe, WindowsThatAreNotAsWishedAreTold) {
    const support::XServer server(folder_, {"640x480x24"});
    const std::string display = "display = \"" + server.display() + "\"\n";
    const std::string inside = placedWall(display + "windows = [[10, 20]]");
    Json ran = probeJson(inside, "2");
    EXPECT_EQ(ran.found["backend"], "glfw");
    EXPECT_TRUE(ran.found["shortcomings"].empty()) << ran.found;
    ran = doctor(inside);
    EXPECT_EQ(ran.status, 0) << ran.found;
    EXPECT_EQ(ran.found["red"], 0) << ran.found;
    EXPECT_EQ(finding(ran, "gl", 1)["backend"], "osmesa");
    EXPECT_EQ(finding(ran, "gl", 2)["backend"], "glfw");

    // A window 96 pixels wide at column 600 of 640 loses 56 columns of 72 rows.
    const std::string across = placedWall(display + "windows = [[600, 20]]");
    const nlohmann::json shortcomings = probeJson(across, "2").found["shortcomings"];
    ASSERT_EQ(shortcomings.size(), 1U) << shortcomings;
    EXPECT_NE(shortcomings[0].get<std::string>().find("4032"), std::string::npos)
        << "the number of hidden pixels is missing";
    ran = doctor(across);
    EXPECT_EQ(ran.status, 1) << ran.found;
    EXPECT_EQ(ran.found["red"], 1) << ran.found;
    EXPECT_EQ(finding(ran, "screen", 2)["good"], false) << ran.found;
    EXPECT_EQ(finding(ran, "gl", 2)["shortcomings"], shortcomings);

    const support::Ran refused = probe(placedWall(display + "monitors = [\"nowhere\"]"), "2");
    EXPECT_EQ(refused.status, base::kExitNotYet) << refused.output;
    EXPECT_NE(refused.output.find("nowhere"), std::string::npos) << refused.output;
    EXPECT_NE(refused.output.find(server.display()), std::string::npos) << refused.output;
}

// With these variables OSMesa would end a rank by SIGSEGV, or refuse OpenGL 3.3.
TEST_F(Probe, AVariableOfMesaThatLeavesNoContextIsNamedByTheSessionAndByTheDoctor) {
    const std::string file = wall(1, 1, "mono");
    for (const std::string variable : {"GALLIUM_DRIVER=zink", "MESA_GL_VERSION_OVERRIDE=2.1"}) {
        environment_ = {variable};
        const Ended ended =
            runToEnd({"--wall", file, "--scene", scene(), "--gl", "osmesa", "--out", out(), "--frames", "3"});
        expectOneLine(ended, "rank 1 (tile r1c1) on " + host() + ": " + variable + ": ");
        const Json ran = doctor(file, variable);
        EXPECT_EQ(ran.status, 1) << ran.found;
        const nlohmann::json gl = finding(ran, "gl", 1);
        EXPECT_EQ(gl["good"], false) << ran.found;
        EXPECT_NE(gl["message"].get<std::string>().find(variable + ": "), std::string::npos) << ran.found;
    }
}

TEST_F(Probe, WhatCannotBeTriedIsOneLine) {
    const std::string file = placedWall("windows = [[10, 20]]");
    for (const auto& [options, named] : {std::pair{"3", "--probe"},
                                         {"2", "--gl glfw"},
                                         {"1 --gl cray", "cray not in {auto,osmesa,egl,glfw}"},
                                         {"-1", "--probe"}}) {
        const support::Ran ran = probe(file, options);
        expectOneLine({ran.status, ran.output}, named);
    }
    const support::Ran ran = probe("/dev/null", "1");
    expectOneLine({ran.status, ran.output}, "standard input");
}

}  // namespace
