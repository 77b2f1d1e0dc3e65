// SPDX-License-Identifier: Apache-2.0
#include "host/version.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/build_id.hpp"
#include "tests/support/run_program.hpp"

namespace {

using nlohmann::json;

TEST(Version, IsALineForPeopleAndAnObjectForPrograms) {
    const std::string line = host::versionText("sandwall-x", {{"journal", 5}, {"state", 7}}, false);
    EXPECT_TRUE(line.starts_with("sandwall-x ")) << line;
    EXPECT_TRUE(line.ends_with(std::string(", build ") + host::buildId() + ", journal 5, state 7")) << line;
    const json object = json::parse(host::versionText("sandwall-x", {{"journal", 5}}, true));
    EXPECT_EQ(object["program"], "sandwall-x");
    EXPECT_EQ(object["build"], host::buildId());
    EXPECT_EQ(object["journal"], 5);
}

TEST(Version, IsAnsweredByEveryProgramOfTheBuild) {
    const std::vector<std::pair<std::string, std::vector<std::string>>> known{
        {"sandwall-master", {"algorithm", "protocol", "journal", "state"}},
        {"sandwall-render-node", {"algorithm", "state"}},
        {"sandwall-haptic-server", {"algorithm", "protocol", "driver_interface"}},
        {"sandwall-replay", {"algorithm", "journal", "state"}},
        {"sandwall-relax", {"algorithm"}},
        {"sandwall-check", {}},
        {"sandwall-compare", {}},
        {"sandwall-track", {}},
        {"sandwall-watch", {"protocol"}},
        {"sandwall-bench", {"algorithm"}}};
    std::size_t asked = 0;
    for (const auto& [program, versions] : known) {
        if (!std::filesystem::exists(std::filesystem::path(SANDWALL_BIN_DIR) / program)) {
            continue;  // a build of the sand alone has few programs
        }
        ++asked;
        const support::Ran ran = support::runProgram(program, "--version --json");
        ASSERT_EQ(ran.status, 0) << program << ": " << ran.output;
        const json object = json::parse(ran.output, nullptr, false);
        ASSERT_TRUE(object.is_object()) << program << ": " << ran.output;
        EXPECT_EQ(object["program"], program);
        EXPECT_EQ(object["build"], host::buildId()) << program;
        for (const std::string& version : versions) {
            EXPECT_TRUE(object.value(version, 0) > 0) << program << " does not tell " << version;
        }
        // Open MPI cannot start without a folder for temporary files. Programs of a job must not need it for an answer:
        // it takes seconds on a busy machine, and all jobs of a user share one folder.
        const support::Ran help =
            support::runCommand("TMPDIR=/dev/null " + support::pathOfProgram(program) + " --help");
        EXPECT_EQ(help.status, 0) << program;
        EXPECT_NE(help.output.find("--version"), std::string::npos) << program << ": " << help.output;
    }
    EXPECT_GE(asked, 2U);
}

}  // namespace
