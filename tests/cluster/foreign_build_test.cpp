// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/events.hpp"
#include "tests/support/processes/mpirun.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

using ForeignBuild = SessionTest;

std::string buildOf(const std::string& program) {
    return nlohmann::json::parse(support::runProgram(program, "--version --json").output)["build"];
}

TEST_F(ForeignBuild, OfARankIsRefusedByName) {
    const std::string bin = SANDWALL_BIN_DIR;
    const std::string command =
        support::mpirunHere() + support::programsByRank({{1, bin + "/sandwall-master --scene " + scene() + " --wall " +
                                                                 wall(1, 2) + " --out " + out()},
                                                         {1, bin + "/sandwall-render-node"},
                                                         {1, bin + "/sandwall-render-node-foreign"}});
    support::ChildProcess job({"/bin/sh", "-c", command}, folder_ / "output.txt");
    EXPECT_EQ(job.wait(kLong), 2) << job.output();
    const std::string output = support::messagesIn(support::withoutBanner(job.output()));
    EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
    for (const std::string& part :
         {"rank 2 (tile r1c2) on " + host(), buildOf("sandwall-master"), buildOf("sandwall-render-node-foreign")}) {
        EXPECT_NE(output.find(part), std::string::npos) << part << " in: " << output;
    }
    EXPECT_NE(buildOf("sandwall-master"), buildOf("sandwall-render-node-foreign"));
}

}  // namespace
