// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lockstep/overlays.hpp"
#include "lockstep/test_pattern.hpp"
#include "scene/material.hpp"
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
    tool,
    material,
    save,
    load,
    capture,
    force,
    stop
};

/// What somebody asks of a running session, typed or through its control socket (docs/operator.md).
struct Command {
    Verb verb = Verb::status;
    std::optional<lockstep::Pattern> pattern;  // of Verb::pattern; none: the next one
    lockstep::Overlay layer{};                 // of Verb::show and Verb::hide
    double number = 0;                         // of Verb::eyeSeparation [m], Verb::material, Verb::force [share]
    scene::ToolChange tool{};                  // of Verb::tool
    std::string word;                          // of Verb::material, which number; of Verb::save and Verb::load
    walls::Stereo stereo{};                    // of Verb::stereo
};

/// Throws base::InputError, with the verbs there are, for a line that is no command.
[[nodiscard]] Command parseCommand(std::string_view line);

}  // namespace master
