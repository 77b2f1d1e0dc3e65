// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "haptic_bridge/hand/tool_keys.hpp"
#include "lockstep/key_list.hpp"
#include "lockstep/overlays.hpp"
#include "lockstep/test_pattern.hpp"
#include "scene/model/material.hpp"

namespace master {

inline constexpr const char* kFixedView = "this wall's view is fixed";  // answer to an attempt to move it
inline constexpr const char* kNearest = "no nearer";                    // answers to a wheel at a limit of the zoom
inline constexpr const char* kFarthest = "no farther; Home shows all";
inline constexpr const char* kFixedSize = "this wall's windows keep their size";  // answer to F11 in one of them
inline constexpr const char* kEndsByAnother = "Esc again within 3 s ends the session";
inline constexpr std::int64_t kLeaveNs = 3'000'000'000;  // [ns], within which a second Escape ends the session
inline constexpr const char* kNoSuchKey = "this key does nothing; F1 shows all keys";

/// State of a session from which keys start.
struct KeyState {
    scene::Material material{};  // with all changes that operators have asked for
    scene::Material ofScene{};   // as the scene file has it
    haptic_bridge::ToolLimits limits{};
    lockstep::Overlays layers{};
    lockstep::Pattern pattern{};
    bool paused = false;
    std::string saveName{};  // name of a file that does not exist
};

/// Returns the operator's commands (verbs.hpp) that a key stands for, in the order in which they are to be carried out.
/// The keys that move the view have none.
[[nodiscard]] std::vector<std::string> commandsOf(const lockstep::KeyFound& key, const KeyState& state);

/// Returns the answer to a key whose commands were carried out, in words for its window, from the state after it.
/// Returns an empty text if the key shows its effect itself, or if the answer comes later.
[[nodiscard]] std::string answerOf(const lockstep::KeyFound& key, const KeyState& after);

// Answers to the wheel.
[[nodiscard]] std::string sizeInWords(const KeyState& after);
[[nodiscard]] std::string depthInWords(double depth /* [tool radius] */);

}  // namespace master
