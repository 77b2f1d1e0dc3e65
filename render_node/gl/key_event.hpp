// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <optional>
#include <string>

#include "base/keystroke.hpp"

namespace render_node {

/// A press of a key as GLFW reports it.
struct KeyEvent {
    int key = 0;        // GLFW_KEY_…: place of the key on a keyboard of the USA
    int modifiers = 0;  // GLFW_MOD_…
    bool repeated = false;
    std::string name;  // character that the key types without modifiers in the present layout; empty for other keys
};

/// Returns the key of an event that types no character: Escape, F1 or Home, and a character with Ctrl or Alt. Returns
/// nullopt if a character follows, or if the key has no code.
[[nodiscard]] std::optional<base::Keystroke> pressedKey(const KeyEvent& event);

/// Returns the key that has typed `character`, with the modifiers of `event`. The layout of the keyboard decides. On a
/// German keyboard Z is where others have Y. A key that types a letter of another script is the letter at its place on
/// a keyboard of the USA.
[[nodiscard]] std::optional<base::Keystroke> typedKey(unsigned character, const KeyEvent& event);

}  // namespace render_node
