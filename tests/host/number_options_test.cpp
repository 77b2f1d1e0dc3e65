// SPDX-License-Identifier: Apache-2.0
// Every option of every program that takes a number, as --options-json lists them. So a new option is tested too.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/processes/run_program.hpp"

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

/// Adds the options of a command, and of its own commands, that take a number. `command` is how a shell starts it.
void addNumbers(const nlohmann::json& list, const std::string& command,
                std::vector<std::pair<std::string, std::string>>& found) {
    for (const nlohmann::json& option : list["options"]) {
        if (option["kind"] == "number") {
            found.emplace_back(command, option["name"]);
        }
    }
    if (list.contains("commands")) {
        for (const nlohmann::json& more : list["commands"]) {
            addNumbers(more, fmt::format("{} {}", command, more["name"].get<std::string>()), found);
        }
    }
}

TEST(NumberOptions, OfEveryProgramRefuseWhatIsNotFinite) {
    std::set<std::string> tried;
    for (const std::string& program : programs()) {
        std::vector<std::pair<std::string, std::string>> options;
        addNumbers(nlohmann::json::parse(support::runProgram(program, "--options-json").output), program, options);
        for (const auto& [command, option] : options) {
            tried.insert(fmt::format("{} {}", program, option));
            for (const std::string number : {"nan", "inf", "-inf"}) {
                const support::Ran ran = support::runProgram(command, fmt::format("{}={} </dev/null", option, number));
                EXPECT_EQ(ran.status, 2) << command << " " << option << "=" << number << "\n" << ran.output;
                EXPECT_EQ(ran.output, fmt::format("{}: {}: must be a finite number, got {}; try --help\n", program,
                                                  option, number));
            }
        }
    }
    // The test has read programs with options, with a default and without one.
    EXPECT_TRUE(tried.contains("sandwall-track --rate"));
    if (std::filesystem::exists(support::pathOfProgram("sandwall-master"))) {
        for (const char* known : {"sandwall-master --frame-timeout", "sandwall-haptic-server --force-scale",
                                  "sandwall-compare --max-bad-share", "sandwall-relax --talus"}) {
            EXPECT_TRUE(tried.contains(known)) << known;
        }
    }
}

}  // namespace
