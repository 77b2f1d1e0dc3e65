// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lockstep/overlays.hpp"
#include "lockstep/test_pattern.hpp"
#include "scene/model/material.hpp"
#include "walls/wall.hpp"

namespace master {

inline constexpr std::size_t kLongestCommand = 1024;  // [byte], without its line feed

enum class Verb : std::uint8_t {
    status,
    pause,
    resume,
    reset,
    undo,
    settle,
    pattern,
    show,
    hide,
    eyeSeparation,
    stereo,
    swapEyes,
    tool,
    material,
    save,
    load,
    capture,
    force,
    stop
};

/// An operator's command to a running session, from standard input or through its control socket (docs/operator.md).
struct Command {
    Verb verb = Verb::status;
    std::optional<lockstep::Pattern> pattern{};  // for Verb::pattern; nullopt: the next pattern
    lockstep::Overlay layer{};                   // for Verb::show and Verb::hide
    double number = 0;                           // for Verb::eyeSeparation [m], Verb::material, Verb::force [share]
    scene::ToolChange tool{};                    // for Verb::tool
    std::string word{};      // name of the number for Verb::material, of the file for Verb::save and Verb::load
    walls::Stereo stereo{};  // for Verb::stereo
    bool on = false;         // for Verb::swapEyes
};

/// Returns the commands with their arguments, such as "show LAYER".
[[nodiscard]] std::vector<std::string> verbsOfSession();

/// Parses a command. Throws base::InputError if `line` is not a valid command; the text lists all verbs if the verb is
/// unknown.
[[nodiscard]] Command parseCommand(std::string_view line);

}  // namespace master
