// SPDX-License-Identifier: Apache-2.0
#include "host/command_line.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/input_error.hpp"

namespace {

enum class Direction : std::uint8_t { north, south };
constexpr auto valuesOf(Direction) {
    return std::array{base::Named{Direction::north, "north"}, base::Named{Direction::south, "south"}};
}

struct Given {
    std::optional<int> status;
    std::string error;
};

/// Parses `words` as the arguments of a program. Returns the exit status and the output on stderr.
Given parse(host::CommandLine& line, std::vector<std::string> words) {
    words.insert(words.begin(), "program");
    std::vector<char*> pointers;
    pointers.reserve(words.size());
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    testing::internal::CaptureStderr();
    Given given;
    given.status = line.parse(static_cast<int>(pointers.size()), pointers.data());
    given.error = testing::internal::GetCapturedStderr();
    return given;
}

class CommandLineOptions : public testing::Test {
protected:
    CommandLineOptions() {
        line_.option("FILE", file_, "a file").required();
        line_.option("--rate", rate_, "a rate").range(1, 1000);
        line_.option("--share", share_, "a share").range(0.0, 1.0);
        line_.option("--way", way_, "a way [m]");
        line_.option("--wait", wait_, "a wait [s]").notNegative();
        line_.option("--kind", kind_, "a kind").oneOf({"grid", "tin"});
        line_.option("--sizes", sizes_, "sizes").commaSeparated();
        line_.choice<bool>("--force", force_, {{"on", true}, {"off", false}}, "whether there is a force");
        const host::Option film = line_.flag("--film", film_, "a film");
        line_.option("--eye", eye_, "its eye").needs(film);
        line_.flag("--live", live_, "no film").excludes(film);
        line_.option("--until", until_, "a step").check([](const std::string& text) {
            return text == "13" ? std::string("13 brings no luck") : std::string();
        });
    }

    void expectRefused(const std::vector<std::string>& words, const std::string& part) {
        const Given given = parse(line_, words);
        EXPECT_EQ(given.status, base::kExitBadInput);
        EXPECT_NE(given.error.find(part), std::string::npos) << given.error;
        EXPECT_EQ(given.error.find('\n'), given.error.size() - 1) << given.error;
        EXPECT_TRUE(given.error.starts_with("tool: ") && given.error.ends_with("; try --help\n")) << given.error;
    }

    host::CommandLine line_{"Does something.", "tool"};
    std::string file_, kind_, eye_;
    int rate_ = 5;
    double share_ = 0, way_ = 0;
    std::optional<double> wait_;
    std::vector<int> sizes_;
    bool force_ = true, film_ = false, live_ = false;
    std::optional<std::uint64_t> until_;
};

TEST_F(CommandLineOptions, TakesValuesOfEveryKind) {
    const Given given = parse(line_, {"a.txt", "--rate", "1000", "--share", "0.25", "--kind", "tin", "--sizes", "8,16",
                                      "--force", "off", "--film", "--eye", "left", "--until", "12"});
    EXPECT_EQ(given.status, std::nullopt) << given.error;
    EXPECT_EQ(file_, "a.txt");
    EXPECT_EQ(rate_, 1000);
    EXPECT_EQ(share_, 0.25);
    EXPECT_EQ(kind_, "tin");
    EXPECT_EQ(sizes_, (std::vector{8, 16}));
    EXPECT_FALSE(force_);
    EXPECT_TRUE(film_);
    EXPECT_EQ(until_, 12U);
}

TEST_F(CommandLineOptions, AnswersHelpWhereverItIsAsked) {
    const auto answers = [&](std::vector<const char*> words) {
        words.insert(words.begin(), "--help");  // the program's name, which must not count as an option
        testing::internal::CaptureStdout();
        const bool answered = line_.answersHelp(static_cast<int>(words.size()), const_cast<char**>(words.data()));
        EXPECT_EQ(testing::internal::GetCapturedStdout().empty(), !answered);
        return answered;
    };
    EXPECT_TRUE(answers({"--help"}));
    EXPECT_TRUE(answers({"--rate", "0", "-h"}));
    EXPECT_FALSE(answers({"a.txt", "--rate", "3"}));
    EXPECT_FALSE(answers({}));
}

TEST_F(CommandLineOptions, ListsThemForOtherPrograms) {
    line_.named("--rate").metavar("HZ").showDefault().offeredBy({"run", "film"});
    line_.named("--way").beginnings({"north", "south"});
    host::CommandLine command = line_.command("send", "sends it");
    int count = 3;
    command.option("--count", count, "how often").positive();
    line_.words("verbs", {"pause", "show LAYER"});
    testing::internal::CaptureStdout();
    EXPECT_EQ(parse(line_, {"--options-json"}).status, 0);
    const auto list = nlohmann::json::parse(testing::internal::GetCapturedStdout());
    const auto option = [&list](const std::string& name) {
        const auto& all = list["options"];
        return *std::find_if(all.begin(), all.end(), [&name](const auto& entry) { return entry["name"] == name; });
    };
    EXPECT_EQ(list["name"], "tool");
    EXPECT_EQ(list["what"], "Does something.");
    EXPECT_EQ(option("FILE"), nlohmann::json::parse(R"({"name": "FILE", "kind": "text", "help": "a file"})"));
    EXPECT_EQ(option("--rate"),
              nlohmann::json::parse(R"({"name": "--rate", "kind": "integer", "help": "a rate", "metavar": "HZ",
                                        "default": "5", "least": 1, "most": 1000, "offered_by": ["run", "film"]})"));
    EXPECT_EQ(option("--way")["beginnings"], (std::vector<std::string>{"north", "south"}));
    EXPECT_EQ(option("--wait")["kind"], "number");
    EXPECT_EQ(option("--wait")["least"], 0);
    EXPECT_EQ(option("--kind")["values"], (std::vector<std::string>{"grid", "tin"}));
    EXPECT_EQ(option("--force")["values"], (std::vector<std::string>{"on", "off"}));
    EXPECT_EQ(option("--sizes")["several"], true);
    EXPECT_EQ(option("--film")["kind"], "flag");
    EXPECT_EQ(option("--live")["excludes"], std::vector<std::string>{"--film"});
    EXPECT_EQ(list["commands"][0]["name"], "send");
    EXPECT_EQ(list["commands"][0]["options"][0]["above"], 0);
    EXPECT_EQ(list["verbs"], (std::vector<std::string>{"pause", "show LAYER"}));
}

TEST_F(CommandLineOptions, TakesTheNamesOfAnEnum) {
    Direction way = Direction::south;
    std::optional<Direction> other;
    line_.choice("--towards", way, "where to");
    line_.choice("--or", other, "or where to");
    EXPECT_EQ(parse(line_, {"a.txt", "--towards", "north", "--or", "south"}).status, std::nullopt);
    EXPECT_EQ(way, Direction::north);
    EXPECT_EQ(other, Direction::south);
    expectRefused({"a", "--towards", "up"}, "up not in {north,south}");
}

TEST_F(CommandLineOptions, LeavesDefaultsAlone) {
    EXPECT_EQ(parse(line_, {"a.txt"}).status, std::nullopt);
    EXPECT_EQ(rate_, 5);
    EXPECT_TRUE(force_);
    EXPECT_EQ(until_, std::nullopt);
}

TEST_F(CommandLineOptions, RefusesWhatItCannotUseInOneLine) {
    expectRefused({}, "FILE is required");
    expectRefused({"a", "--rate", "0"}, "--rate");
    expectRefused({"a", "--rate", "1001"}, "1001");
    expectRefused({"a", "--rate", "2.5"}, "2.5");
    expectRefused({"a", "--share", "1.01"}, "--share");
    expectRefused({"a", "--kind", "cube"}, "cube not in {grid,tin}");
    expectRefused({"a", "--force", "maybe"}, "maybe not in {on,off}");
    expectRefused({"a", "--sizes", "8,x"}, "--sizes");
    expectRefused({"a", "--eye", "left"}, "--film");
    expectRefused({"a", "--live", "--film"}, "--film");
    expectRefused({"a", "--until", "13"}, "13 brings no luck");
    expectRefused({"a", "--unknown"}, "--unknown");
}

// CLI11 converts all of these texts. Its ranges do not refuse NaN, because each comparison with NaN is false.
TEST_F(CommandLineOptions, RefusesNumbersThatAreNotFinite) {
    for (const std::string option : {"--share", "--way", "--wait"}) {
        for (const std::string number : {"nan", "NaN", "-nan", "nan(0x1)", "inf", "-inf", "Infinity", "1e999"}) {
            expectRefused({"a", fmt::format("{}={}", option, number)},
                          fmt::format("{}: must be a finite number, got {}", option, number));
        }
        expectRefused({"a", option, "far"}, option);
    }
    EXPECT_EQ(parse(line_, {"a", "--way", "-1e300", "--wait", "0x10"}).status, std::nullopt);
    EXPECT_EQ(way_, -1e300);
    EXPECT_EQ(wait_, 16);
}

TEST(CommandLineCommands, OneOfThemMustBeGiven) {
    int rate = 0;
    host::CommandLine line("Does one of two things.", "tool");
    host::CommandLine first = line.command("first", "the one");
    const host::CommandLine second = line.command("second", "the other");
    first.option("--rate", rate, "a rate");
    EXPECT_EQ(parse(line, {}).status, base::kExitBadInput);
    EXPECT_EQ(parse(line, {"first", "--rate", "3"}).status, std::nullopt);
    EXPECT_TRUE(first.given());
    EXPECT_FALSE(second.given());
    EXPECT_EQ(rate, 3);
}

TEST(CommandLine, MakesTheProcessWriteNoFileThatOthersMayWriteTo) {
    const mode_t before = umask(0);
    const host::CommandLine line("Does something.", "tool");
    EXPECT_EQ(umask(before), 022U);
}

TEST(CommandLine, RefusesAValueOfTheEventsVariableThatIsNeither0Nor1) {
    const char* const before = std::getenv("SANDWALL_EVENTS");
    const std::optional<std::string> kept = before == nullptr ? std::nullopt : std::optional<std::string>(before);
    for (const auto& [value, error] : {std::pair{"0", ""},
                                       {"1", ""},
                                       {"", ""},
                                       {"yes", "tool: SANDWALL_EVENTS: must be 0 or 1, got 'yes'\n"},
                                       {"11", "tool: SANDWALL_EVENTS: must be 0 or 1, got '11'\n"}}) {
        setenv("SANDWALL_EVENTS", value, 1);
        host::CommandLine line("Does something.", "tool");
        const Given given = parse(line, {});
        EXPECT_EQ(given.error, error);
        EXPECT_EQ(given.status, given.error.empty() ? std::nullopt : std::optional<int>(base::kExitBadInput));
    }
    kept ? setenv("SANDWALL_EVENTS", kept->c_str(), 1) : unsetenv("SANDWALL_EVENTS");
}

int exitStatus(const std::function<int()>& run) {
    host::CommandLine line("Does something.", "tool");
    std::string name = "program";
    char* words[] = {name.data()};
    return host::runMain(line, 1, words, run, 7);
}

TEST(RunMain, TellsBadInputFromFailures) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(exitStatus([] { return 1; }), 1);
    EXPECT_EQ(exitStatus([]() -> int { throw base::InputError("a.txt:3: bad"); }), base::kExitBadInput);
    EXPECT_EQ(exitStatus([]() -> int { throw std::runtime_error("no room"); }), 7);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "tool: a.txt:3: bad\ntool: failed: no room\n");
}

}  // namespace
