// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace host {

/// One option of a command line, to be described further: `line.option("--rate", rate, "…").range(1, 1000)`.
/// Valid as long as its CommandLine.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option required() const;
    /// --help shows the value that the variable has now.
    Option showDefault() const;
    /// Both ends are allowed. A value of another type, or outside, is refused.
    Option range(int lowest, int highest) const;
    Option range(double lowest, double highest) const;
    Option positive() const;
    Option notNegative() const;
    Option oneOf(const std::vector<std::string>& allowed) const;
    /// `refusal` returns what is wrong with a value, or an empty text.
    Option check(std::function<std::string(const std::string&)> refusal) const;
    /// Each occurrence takes one value, where a vector would take all that follow.
    Option oneValueEach() const;
    /// A vector's values stand in one word, separated by commas.
    Option commaSeparated() const;
    Option needs(const Option& other) const;
    Option excludes(const Option& other) const;

private:
    CLI::Option* option_;
};

/// The options of a program. It wraps CLI11, whose headers take each source that includes them ten seconds to compile.
/// Not thread-safe.
class CommandLine {
public:
    /// `what` the program does is the first line of --help.
    CommandLine(const std::string& what, const std::string& name);
    ~CommandLine();
    CommandLine(CommandLine&&) noexcept;
    CommandLine& operator=(CommandLine&&) = delete;

    /// `name` begins with "--", or is what --help calls the argument at this place. T: std::string, a path, int,
    /// std::uint16_t, std::uint32_t, std::uint64_t, std::int64_t, double; an optional of most of these; a vector of int
    /// or std::string. command_line.cpp lists them all.
    template <class T>
    Option option(const std::string& name, T& value, const std::string& help = "");
    Option flag(const std::string& name, bool& value, const std::string& help = "");
    /// Sets `value` to that of the chosen name.
    template <class T>
    Option choice(const std::string& name, T& value, const std::vector<std::pair<std::string, T>>& choices,
                  const std::string& help) {
        std::vector<std::string> names(choices.size());
        std::transform(choices.begin(), choices.end(), names.begin(), [](const auto& choice) { return choice.first; });
        return chosen(
            name, names, [&value, choices](std::size_t index) { value = choices[index].second; }, help);
    }
    /// An option described before.
    [[nodiscard]] Option named(const std::string& name) const;

    /// A command such as `bench sweeps`, with options of its own; one of the commands must then be given.
    CommandLine command(const std::string& name, const std::string& what);
    /// Whether the user gave this command.
    [[nodiscard]] bool given() const;

    [[nodiscard]] std::string name() const;
    /// The last lines of --help.
    void footer(const std::string& text);

    /// Prints the help text and returns true if the arguments contain --help or -h. For programs that start something
    /// slow before parse(), which answers --help too.
    [[nodiscard]] bool answersHelp(int argc, char** argv) const;
    /// Reads the arguments. Returns the exit status with which the program has to end, after --help or after a line on
    /// stderr that says what is wrong; nullopt if the program can start.
    [[nodiscard]] std::optional<int> parse(int argc, char** argv);

private:
    explicit CommandLine(CLI::App* command);
    Option chosen(const std::string& name, const std::vector<std::string>& names, std::function<void(std::size_t)> take,
                  const std::string& help);

    std::unique_ptr<CLI::App> owned_;  // null for a command, which the program's command line owns
    CLI::App* app_;
};

/// Adds --sand-threads, for programs that hold a replica of the sand.
void addSandThreads(CommandLine& line, int& threads);

/// The frame of every program's main: parses, calls `run`, and prints one line on stderr for whatever goes wrong. The
/// line begins with the program's name.
/// Returns run's value; kExitBadInput for unusable options and input; `failed` for errors of our own, which differs in
/// programs in which 1 is an answer.
int runMain(CommandLine& line, int argc, char** argv, const std::function<int()>& run, int failed = 1);

}  // namespace host
