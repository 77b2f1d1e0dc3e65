// SPDX-License-Identifier: Apache-2.0
#include "host/version.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/build_id.hpp"
#include "tests/support/processes/run_program.hpp"

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
            EXPECT_TRUE(object.value(version, 0) > 0) << program << " does not print its version of " << version;
        }
        // Open MPI cannot start without a folder for temporary files. Programs of an MPI job must answer --help without
        // starting it. The start takes seconds on a busy machine, and all jobs of a user share one folder.
        const support::Ran help =
            support::runCommand("TMPDIR=/dev/null '" + support::pathOfProgram(program) + "' --help");
        EXPECT_EQ(help.status, 0) << program;
        EXPECT_NE(help.output.find("--version"), std::string::npos) << program << ": " << help.output;
    }
    EXPECT_GE(asked, 2U);
}

// The messages of a session come from several programs. So a program that ends because of bad input must print its
// name.
TEST(Refusals, BeginWithTheProgramsName) {
    const std::vector<std::pair<std::string, std::string>> refused{
        {"sandwall-haptic-server", "--scene /no/file.toml --device spacenav"},
        {"sandwall-replay", "/no/file.journal"},
        {"sandwall-relax", "/no/file.asc out.asc --talus 30"},
        {"sandwall-check", "/no/file.toml"},
        {"sandwall-compare", "/no/a.png /no/b.png"},
        {"sandwall-track", "--trace /no/file.csv"},
        {"sandwall-track", ""},
        {"sandwall-watch", ":7750"},
        {"sandwall-render-node", "--probe 1 </dev/null"},
        {"sandwall-bench", "explain /no/file.toml"}};
    std::size_t asked = 0;
    for (const auto& [program, arguments] : refused) {
        if (!std::filesystem::exists(std::filesystem::path(SANDWALL_BIN_DIR) / program)) {
            continue;  // a build of the sand alone has few programs
        }
        ++asked;
        const support::Ran ran = support::runProgram(program, arguments);
        EXPECT_EQ(ran.status, 2) << program << ": " << ran.output;
        EXPECT_TRUE(ran.output.starts_with(program + ": ")) << ran.output;
        EXPECT_EQ(ran.output.find(program, 1), std::string::npos) << "the name must be printed once: " << ran.output;
        EXPECT_EQ(ran.output.find('\n'), ran.output.size() - 1) << ran.output;
    }
    EXPECT_GE(asked, 2U);
}

}  // namespace
