// SPDX-License-Identifier: Apache-2.0
#include "master/operator_command.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string>

#include "files/input_error.hpp"
#include "walls/wall_check.hpp"

namespace master {
namespace {

struct VerbName {
    std::string_view name;
    std::string_view argument;  // what stands behind it; empty: nothing does
    Verb verb;
};

constexpr std::array<VerbName, 12> kVerbs{{{"status", "", Verb::status},
                                           {"pause", "", Verb::pause},
                                           {"resume", "", Verb::resume},
                                           {"reset", "", Verb::reset},
                                           {"undo", "", Verb::undo},
                                           {"settle", "", Verb::settle},
                                           {"pattern", "NAME", Verb::pattern},
                                           {"show", "LAYER", Verb::show},
                                           {"hide", "LAYER", Verb::hide},
                                           {"eye-separation", "METRES", Verb::eyeSeparation},
                                           {"capture", "", Verb::capture},
                                           {"stop", "", Verb::stop}}};

std::string knownVerbs() {
    std::string known;
    for (const VerbName& verb : kVerbs) {
        known += fmt::format("{}{}{}{}", known.empty() ? "" : ", ", verb.name, verb.argument.empty() ? "" : " ",
                             verb.argument);
    }
    return known;
}

double parseSeparation(std::string_view text) {
    double metres = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), metres);
    // Written so that what is no number is out of range.
    if (error != std::errc() || end != text.data() + text.size() ||
        !(metres >= 0 && metres <= walls::kMaxEyeSeparation)) {
        throw files::InputError(fmt::format("eye-separation must be 0 to {} metres, got '{}'", walls::kMaxEyeSeparation,
                                            text.substr(0, 80)));
    }
    return metres;
}

}  // namespace

Command parseCommand(std::string_view line) {
    const std::size_t space = line.find(' ');
    const std::string_view word = line.substr(0, space);
    const std::string_view argument = space == std::string_view::npos ? "" : line.substr(space + 1);
    for (const VerbName& verb : kVerbs) {
        if (verb.name != word) {
            continue;
        }
        if (verb.argument.empty() != argument.empty()) {
            throw files::InputError(verb.argument.empty()
                                        ? fmt::format("{} takes no argument, got '{}'", word, argument.substr(0, 80))
                                        : fmt::format("{} needs {}", word, verb.argument));
        }
        Command command{verb.verb, std::nullopt, {}, 0};
        if (verb.verb == Verb::eyeSeparation) {
            command.metres = parseSeparation(argument);
        } else if (verb.verb == Verb::show || verb.verb == Verb::hide) {
            command.layer = lockstep::parseLayer(argument.substr(0, 80));
        } else if (verb.verb == Verb::pattern && argument != "next") {
            try {
                command.pattern = lockstep::parsePattern(argument.substr(0, 80));
            } catch (const files::InputError& error) {
                throw files::InputError(fmt::format("{}, next", error.what()));
            }
        }
        return command;
    }
    throw files::InputError(fmt::format("'{}' is no command; these are: {}", line.substr(0, 80), knownVerbs()));
}

}  // namespace master
