// SPDX-License-Identifier: Apache-2.0
#include "master/operator/verb_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "master/journal/saved_sand.hpp"
#include "walls/wall_check.hpp"

namespace master {
namespace {

/// Returns the finite number that is the whole of `text`; nullopt for any other text. A sign + is refused, because it
/// reads as a change by so much.
std::optional<double> numberIn(std::string_view text) {
    return text.starts_with('+') ? std::nullopt : base::numberOf(text);
}

double parseNumber(std::string_view what, std::string_view text) {
    const std::optional<double> number = numberIn(text);
    if (!number) {
        throw base::InputError(fmt::format("{} must be a number, got '{}'", what, text.substr(0, 80)));
    }
    return *number;
}

}  // namespace

std::optional<lockstep::Pattern> readPattern(std::string_view text) {
    if (text == "next") {
        return std::nullopt;
    }
    try {
        return lockstep::parsePattern(text.substr(0, 80));
    } catch (const base::InputError& error) {
        throw base::InputError(fmt::format("{}, next", error.what()));
    }
}

lockstep::Overlay readLayer(std::string_view text) { return lockstep::parseOverlay(text.substr(0, 80)); }

walls::Stereo readStereo(std::string_view text) { return walls::stereoNamed(std::string(text.substr(0, 80))); }

double readSeparation(std::string_view text) {
    const std::optional<double> metres = numberIn(text);
    if (!metres || *metres < 0 || *metres > walls::kMaxEyeSeparation) {
        throw base::InputError(fmt::format("eye-separation must be 0 to {} metres, got '{}'", walls::kMaxEyeSeparation,
                                           text.substr(0, 80)));
    }
    return *metres;
}

scene::ToolChange readTool(std::string_view text) {
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

double readShare(std::string_view text) {
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

MaterialChange readMaterial(std::string_view text) {
    const std::size_t space = text.find(' ');
    if (space == std::string_view::npos) {
        throw base::InputError("material needs KEY VALUE");
    }
    const std::string_view word = text.substr(0, std::min<std::size_t>(space, 80));
    return {std::string(word), parseNumber(word, text.substr(space + 1))};
}

std::string readSaveName(std::string_view text) {
    if (!isSaveName(text)) {
        throw base::InputError(
            fmt::format("a name has 1 to 64 letters, digits, - and _, got '{}'", text.substr(0, 80)));
    }
    return std::string(text);
}

bool readSwapEyes(std::string_view text) {
    if (text != "on" && text != "off") {
        throw base::InputError(fmt::format("swap-eyes needs on or off, got '{}'", text.substr(0, 80)));
    }
    return text == "on";
}

std::string_view argumentIn(std::string_view line, std::string_view name, std::string_view form) {
    const std::string_view argument = line.size() > name.size() ? line.substr(name.size() + 1) : "";
    if (form.empty() != argument.empty()) {
        throw base::InputError(form.empty()
                                   ? fmt::format("{} takes no argument, got '{}'", name, argument.substr(0, 80))
                                   : fmt::format("{} needs {}", name, form));
    }
    return argument;
}

void refuseVerb(std::string_view line, const std::vector<std::string>& known) {
    throw base::InputError(
        fmt::format("'{}' is not a command; the commands are: {}", line.substr(0, 80), fmt::join(known, ", ")));
}

}  // namespace master
