// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/names.hpp"
#include "host/option_list.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace host {

/// One option of a command line, for further description: `line.option("--rate", rate, "…").range(1, 1000)`.
/// Valid as long as its CommandLine.
class Option {
public:
    Option(CLI::Option* option, ListedOption* listed) : option_(option), listed_(listed) {}

    Option required() const;
    /// Makes --help show the value that the variable has at this call.
    Option showDefault() const;
    /// Makes --help show this text as the value without the option.
    Option fallback(const std::string& text) const;
    /// Refuses a value of another type, or outside the range. Both ends are allowed.
    Option range(int lowest, int highest) const;
    Option range(double lowest, double highest) const;
    Option positive() const;
    Option notNegative() const;
    Option oneOf(const std::vector<std::string>& allowed) const;
    /// Refuses values for which `refusal` returns a message. It returns an empty text for a valid value.
    Option check(std::function<std::string(const std::string&)> refusal) const;
    /// Lets each occurrence take one value. Otherwise a vector takes all values that follow.
    Option oneValueEach() const;
    /// Reads the values of a vector from one argument, separated by commas.
    Option commaSeparated() const;
    Option needs(const Option& other) const;
    Option excludes(const Option& other) const;
    /// Sets the word that help prints for the value, such as "HOST:PORT".
    Option metavar(const std::string& word) const;
    /// Tells how a value may begin, such as "script:". For completion; other values are not refused here.
    Option beginnings(const std::vector<std::string>& words) const;
    /// Makes these commands of the launcher, such as "run", offer the option and pass it on to this program.
    Option offeredBy(const std::vector<std::string>& commands) const;

private:
    CLI::Option* option_;
    ListedOption* listed_;
};

/// The enum of a variable that holds it, or that may hold it.
template <class T>
struct ValueIn {
    using Type = T;
};
template <class T>
struct ValueIn<std::optional<T>> {
    using Type = T;
};
template <class T>
using ValueOf = typename ValueIn<T>::Type;

/// The options of a program. It wraps CLI11, whose headers take each source that includes them ten seconds to compile.
/// Not thread-safe.
class CommandLine {
public:
    /// `what` is the first line of --help and describes the program. Also calls keepOthersFromWriting()
    /// (host/regular_file.hpp), so that no program makes a file to which other users may write.
    CommandLine(const std::string& what, const std::string& name);
    ~CommandLine();
    CommandLine(CommandLine&&) noexcept;
    CommandLine& operator=(CommandLine&&) = delete;

    /// Adds an option if `name` begins with "--", otherwise an argument at this place. T: std::string, a path, int,
    /// std::uint16_t, std::uint32_t, std::uint64_t, std::int64_t, double; an optional of most of these; a vector of int
    /// or std::string. command_line.cpp lists them all. A double must be a finite number.
    template <class T>
    Option option(const std::string& name, T& value, const std::string& help = "");
    Option flag(const std::string& name, bool& value, const std::string& help = "");
    /// Adds an option that sets `value` to the value of the name that the user chooses.
    template <class T>
    Option choice(const std::string& name, T& value, const std::vector<std::pair<std::string, T>>& choices,
                  const std::string& help) {
        std::vector<std::string> names(choices.size());
        std::transform(choices.begin(), choices.end(), names.begin(), [](const auto& choice) { return choice.first; });
        return chosen(
            name, names, [&value, choices](std::size_t index) { value = choices[index].second; }, help);
    }
    /// Adds an option that sets `value` to the value that valuesOf() lists with the name that the user chooses. Help
    /// shows the name of the value that the variable has at this call.
    template <class T, base::NamedEnum Enum = ValueOf<T>>
    Option choice(const std::string& name, T& value, const std::string& help) {
        std::vector<std::pair<std::string, T>> choices;
        for (const base::Named<Enum>& known : valuesOf(Enum{})) {
            choices.emplace_back(known.name, known.value);
        }
        Option added = choice(name, value, choices, help);
        if constexpr (std::is_same_v<T, Enum>) {
            added.fallback(std::string(base::nameOf(value)));
        }
        return added;
    }
    /// Returns an option that was added before.
    [[nodiscard]] Option named(const std::string& name) const;

    /// Adds a command such as `bench sweeps`, with its own options. The user must then give one of the commands.
    CommandLine command(const std::string& name, const std::string& what);
    /// Returns whether the user gave this command.
    [[nodiscard]] bool given() const;

    [[nodiscard]] std::string name() const;
    /// Sets the last lines of --help.
    void footer(const std::string& text);

    /// Adds a list of words that is no option, such as the verbs of a session, to what --options-json prints.
    void words(const std::string& list, std::vector<std::string> words);

    /// Prints the help text and returns true if the arguments contain --help or -h, or prints OptionList::json() if
    /// they contain --options-json. For programs that start something slow before parse(), which answers both too.
    [[nodiscard]] bool answersHelp(int argc, char** argv) const;
    /// Reads the arguments, and checks the environment variable SANDWALL_EVENTS. Returns nullopt if the program can
    /// start. After --help, or after a line on stderr that says what is wrong, returns the exit status with which the
    /// program has to end.
    [[nodiscard]] std::optional<int> parse(int argc, char** argv);

private:
    CommandLine(CLI::App* command, std::shared_ptr<OptionList> list);
    Option chosen(const std::string& name, const std::vector<std::string>& names, std::function<void(std::size_t)> take,
                  const std::string& help);
    Option listed(CLI::Option* option, const std::string& name, const char* kind, bool several,
                  const std::string& help) const;

    std::unique_ptr<CLI::App> owned_;  // null for a command, which the program's command line owns
    CLI::App* app_;
    std::shared_ptr<OptionList> list_;  // of a command: part of the program's list
};

/// Adds --sand-threads, for programs that hold a replica of the sand.
Option addSandThreads(CommandLine& line, int& threads);

/// Frame of every program's main. Parses the options, calls `run`, and prints one line on stderr for an error. The line
/// begins with the program's name.
/// Returns the value of `run`, or kExitBadInput for options and input that cannot be used. Returns `failed` for every
/// other error; programs that use 1 as an answer pass another number.
int runMain(CommandLine& line, int argc, char** argv, const std::function<int()>& run, int failed = 1);

}  // namespace host
