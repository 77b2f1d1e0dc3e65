// SPDX-License-Identifier: Apache-2.0
#include "master/operator/operator_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "master/journal/saved_sand.hpp"
#include "walls/wall_check.hpp"

namespace master {
namespace {

struct VerbName {
    std::string_view name;
    std::string_view argument;  // form of the argument; empty without one
    Verb verb;
};

constexpr std::array<VerbName, 19> kVerbs{
    {{"status", "", Verb::status},
     {"pause", "", Verb::pause},
     {"resume", "", Verb::resume},
     {"reset", "", Verb::reset},
     {"undo", "", Verb::undo},
     {"settle", "", Verb::settle},
     {"pattern", "NAME|none|next", Verb::pattern},
     {"show", "LAYER", Verb::show},
     {"hide", "LAYER", Verb::hide},
     {"eye-separation", "METRES", Verb::eyeSeparation},
     {"stereo", "MODE", Verb::stereo},
     {"swap-eyes", "on|off", Verb::swapEyes},
     {"tool", "[SHAPE] [radius=R] [width=W] [heading=DEG] [foot=left|right]", Verb::tool},
     {"material", "KEY VALUE", Verb::material},
     {"save", "NAME", Verb::save},
     {"load", "NAME", Verb::load},
     {"capture", "", Verb::capture},
     {"force", "on|off|scale SHARE", Verb::force},
     {"stop", "", Verb::stop}}};

/// Returns the finite number that is the whole of `text`; nullopt for any other text.
std::optional<double> numberIn(std::string_view text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = error == std::errc() && end == text.data() + text.size() && std::isfinite(number);
    return whole ? std::optional(number) : std::nullopt;
}

double parseSeparation(std::string_view text) {
    const std::optional<double> metres = numberIn(text);
    if (!metres || *metres < 0 || *metres > walls::kMaxEyeSeparation) {
        throw base::InputError(fmt::format("eye-separation must be 0 to {} metres, got '{}'", walls::kMaxEyeSeparation,
                                           text.substr(0, 80)));
    }
    return *metres;
}

double parseNumber(std::string_view what, std::string_view text) {
    const std::optional<double> number = numberIn(text);
    if (!number) {
        throw base::InputError(fmt::format("{} must be a number, got '{}'", what, text.substr(0, 80)));
    }
    return *number;
}

/// Parses the argument of "tool": a SHAPE, a radius alone, and KEY=VALUE, in any order.
scene::ToolChange parseTool(std::string_view text) {
    scene::ToolChange change;
    while (!text.empty()) {
        const std::size_t space = text.find(' ');
        const std::string_view word = text.substr(0, space);
        text = space == std::string_view::npos ? "" : text.substr(space + 1);
        const std::size_t equals = word.find('=');
        const std::string_view key = word.substr(0, std::min<std::size_t>(equals, 80));
        const std::string_view value = equals == std::string_view::npos ? "" : word.substr(equals + 1);
        if (key == "radius" || key == "width" || key == "heading") {
            auto& number = key == "radius" ? change.radius : key == "width" ? change.width : change.heading;
            number = parseNumber(fmt::format("a tool's {}", key), value);
        } else if (key == "foot" && (value == "left" || value == "right")) {
            change.leftFoot = value == "left";
        } else if (const auto kind = base::valueNamed<sand::ToolKind>(word)) {
            change.kind = kind;
        } else if (const auto radius = numberIn(word)) {
            change.radius = radius;
        } else if (!word.empty()) {
            throw base::InputError(
                fmt::format("a tool is one of {}, or has radius=, width=, heading=, foot=left or right, got '{}'",
                            fmt::join(base::namesOf<sand::ToolKind>(), ", "), word.substr(0, 80)));
        }
    }
    return change;
}

/// Parses the share of the force that the hand feels. "on" is 1.
double parseShare(std::string_view text) {
    if (text == "on" || text == "off") {
        return text == "on" ? 1 : 0;
    }
    constexpr std::string_view kScale = "scale ";
    const std::optional<double> share = text.starts_with(kScale) ? numberIn(text.substr(kScale.size())) : std::nullopt;
    if (!share || *share < 0 || *share > 1) {
        throw base::InputError(
            fmt::format("force needs on, off or scale SHARE with a share of 0 to 1, got '{}'", text.substr(0, 80)));
    }
    return *share;
}

void parseArgument(std::string_view argument, Command& command) {
    switch (command.verb) {
        case Verb::eyeSeparation:
            command.number = parseSeparation(argument);
            break;
        case Verb::tool:
            command.tool = parseTool(argument);
            break;
        case Verb::material: {
            const std::size_t space = argument.find(' ');
            if (space == std::string_view::npos) {
                throw base::InputError("material needs KEY VALUE");
            }
            command.word = argument.substr(0, std::min<std::size_t>(space, 80));
            command.number = parseNumber(command.word, argument.substr(space + 1));
            break;
        }
        case Verb::save:
        case Verb::load:
            command.word = argument;
            if (!isSaveName(argument)) {
                throw base::InputError(
                    fmt::format("a name has 1 to 64 letters, digits, - and _, got '{}'", argument.substr(0, 80)));
            }
            break;
        case Verb::force:
            command.number = parseShare(argument);
            break;
        case Verb::stereo:
            command.stereo = walls::stereoNamed(std::string(argument.substr(0, 80)));
            break;
        case Verb::swapEyes:
            if (argument != "on" && argument != "off") {
                throw base::InputError(fmt::format("swap-eyes needs on or off, got '{}'", argument.substr(0, 80)));
            }
            command.on = argument == "on";
            break;
        case Verb::show:
        case Verb::hide:
            command.layer = lockstep::parseOverlay(argument.substr(0, 80));
            break;
        case Verb::pattern:
            if (argument == "next") {
                break;
            }
            try {
                command.pattern = lockstep::parsePattern(argument.substr(0, 80));
            } catch (const base::InputError& error) {
                throw base::InputError(fmt::format("{}, next", error.what()));
            }
            break;
        default:
            break;
    }
}

}  // namespace

std::vector<std::string> verbsOfSession() {
    std::vector<std::string> known;
    known.reserve(kVerbs.size());
    for (const VerbName& verb : kVerbs) {
        known.push_back(fmt::format("{}{}{}", verb.name, verb.argument.empty() ? "" : " ", verb.argument));
    }
    return known;
}

Command parseCommand(std::string_view line) {
    const std::size_t space = line.find(' ');
    const std::string_view word = line.substr(0, space);
    const std::string_view argument = space == std::string_view::npos ? "" : line.substr(space + 1);
    for (const VerbName& verb : kVerbs) {
        if (verb.name != word) {
            continue;
        }
        if (verb.argument.empty() != argument.empty()) {
            throw base::InputError(verb.argument.empty()
                                       ? fmt::format("{} takes no argument, got '{}'", word, argument.substr(0, 80))
                                       : fmt::format("{} needs {}", word, verb.argument));
        }
        Command command;
        command.verb = verb.verb;
        parseArgument(argument, command);
        return command;
    }
    throw base::InputError(fmt::format("'{}' is not a command; the commands are: {}", line.substr(0, 80),
                                       fmt::join(verbsOfSession(), ", ")));
}

}  // namespace master
