// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lockstep/overlays.hpp"
#include "lockstep/test_pattern.hpp"
#include "scene/model/material.hpp"
#include "walls/wall.hpp"

namespace master {

inline constexpr std::size_t kLongestCommand = 1024;  // [byte], without its line feed

// Each function reads the argument of a verb (verbs.hpp). Throws base::InputError in one line if it is not valid.

[[nodiscard]] std::optional<lockstep::Pattern> readPattern(std::string_view text);  // nullopt: the next pattern
[[nodiscard]] lockstep::Overlay readLayer(std::string_view text);
[[nodiscard]] walls::Stereo readStereo(std::string_view text);
[[nodiscard]] double readSeparation(std::string_view text);  // [m], of the eyes
/// Reads a SHAPE, a radius alone, and KEY=VALUE, in any order.
[[nodiscard]] scene::ToolChange readTool(std::string_view text);
[[nodiscard]] std::string readSaveName(std::string_view text);
[[nodiscard]] bool readSwapEyes(std::string_view text);
[[nodiscard]] double readShare(std::string_view text);  // of the force that the hand feels; "on" is 1

/// A new value of a number of scene::Material, by its word.
struct MaterialChange {
    std::string word;
    double number = 0;
};
[[nodiscard]] MaterialChange readMaterial(std::string_view text);

/// Returns the argument in `line`, which begins with the verb `name`. Throws base::InputError if an argument is there
/// and `form` is empty, or the other way round.
[[nodiscard]] std::string_view argumentIn(std::string_view line, std::string_view name, std::string_view form);
/// Throws base::InputError, which lists the `known` verbs with their arguments.
[[noreturn]] void refuseVerb(std::string_view line, const std::vector<std::string>& known);

}  // namespace master
