// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace host {

/// What other programs need to know about one option of a command line.
struct ListedOption {
    std::string name;                     // "--pace", or "JOURNAL" for an argument at a place
    std::string help;                     // one line
    std::string kind;                     // "flag", "text", "integer" or "number"
    std::string metavar;                  // word for the value in help, such as "HOST:PORT"; may be empty
    std::optional<std::string> fallback;  // value without the option, as text; nullopt if help shows none
    std::vector<std::string> values;      // all allowed values; empty if there are others
    std::vector<std::string> beginnings;  // how a value may begin, such as "script:"; empty if nothing is known
    std::vector<std::string> excludes;    // names of options that cannot be given with this one
    std::vector<std::string> offeredBy;   // commands of the launcher that offer the option and pass it on
    std::optional<double> least, most;    // allowed range, both ends included
    bool aboveLeast = false;              // whether `least` itself is refused
    bool several = false;                 // whether the option may be given several times
};

/// The options of a program, or of one of its commands.
struct OptionList {
    std::string name;  // of the program or the command
    std::string what;  // one line
    std::deque<ListedOption> options;
    std::deque<OptionList> commands;
    std::vector<std::pair<std::string, std::vector<std::string>>> words;  // other lists, see CommandLine::words()

    /// Returns the list as one JSON object, for the launcher, its help and the completion of a shell.
    [[nodiscard]] std::string json() const;
};

}  // namespace host
