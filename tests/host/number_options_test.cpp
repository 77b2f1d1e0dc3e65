// SPDX-License-Identifier: Apache-2.0
// Every option of every program that takes a number, as --help lists them. So a new option is tested too.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <vector>

#include "tests/support/run_program.hpp"

namespace {

/// Returns the first group of each match of `pattern` in `text`.
std::vector<std::string> matches(const std::string& text, const char* pattern) {
    const std::regex expression(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match) {
        found.push_back((*match)[1]);
    }
    return found;
}

/// Returns the programs that are installed and that this build has, and sandwall-bench.
std::vector<std::string> programs() {
    std::ifstream file(SANDWALL_SOURCE_DIR "/cmake/Install.cmake");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::vector<std::string> names;
    for (const std::string& list : matches(text, "set\\(programs ([^)]*)\\)")) {
        names = matches(list, "(sandwall-[a-z-]+)");
    }
    names.emplace_back("sandwall-bench");
    std::erase_if(names,
                  [](const std::string& name) { return !std::filesystem::exists(support::pathOfProgram(name)); });
    return names;
}

/// Returns the program alone, or the program with each of its commands.
std::vector<std::string> commandsOf(const std::string& program) {
    const std::string help = support::runProgram(program, "--help").output;
    const std::size_t list = help.find("\nSubcommands:\n");
    if (list == std::string::npos) {
        return {program};
    }
    std::vector<std::string> commands;
    for (const std::string& name : matches(help.substr(list), "\n  ([a-z-]+)")) {
        commands.push_back(fmt::format("{} {}", program, name));
    }
    return commands;
}

TEST(NumberOptions, OfEveryProgramRefuseWhatIsNotFinite) {
    std::set<std::string> tried;
    for (const std::string& program : programs()) {
        for (const std::string& command : commandsOf(program)) {
            const std::string help = support::runProgram(command, "--help").output;
            for (const std::string& option : matches(help, "\n  (?:-[a-z],)?(--[a-z-]+) FLOAT")) {
                tried.insert(fmt::format("{} {}", program, option));
                for (const std::string number : {"nan", "inf", "-inf"}) {
                    const support::Ran ran =
                        support::runProgram(command, fmt::format("{}={} </dev/null", option, number));
                    EXPECT_EQ(ran.status, 2) << command << " " << option << "=" << number << "\n" << ran.output;
                    EXPECT_EQ(ran.output, fmt::format("{}: {}: must be a finite number, got {}; try --help\n", program,
                                                      option, number));
                }
            }
        }
    }
    // The test has read the help of programs with options, with a default and with none.
    EXPECT_TRUE(tried.contains("sandwall-track --rate"));
    if (std::filesystem::exists(support::pathOfProgram("sandwall-master"))) {
        for (const char* known : {"sandwall-master --frame-timeout", "sandwall-haptic-server --force-scale",
                                  "sandwall-compare --max-bad-share", "sandwall-relax --talus"}) {
            EXPECT_TRUE(tried.contains(known)) << known;
        }
    }
}

}  // namespace
