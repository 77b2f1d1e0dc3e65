// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/keystroke.hpp"

namespace lockstep {

/// Effect of a key in a wall's windows.
enum class KeyAction : std::uint8_t {
    tool,  // one of the tools, in the order of their kinds
    larger,
    smaller,
    turn,       // turns the tool to the left, or by its second key to the right
    sceneTool,  // tool and humidity as the scene has them, and the usual depth
    humidity,   // makes the sand wetter, or by its second key drier
    undo,
    redo,
    reset,
    frameView,
    pause,
    save,
    capture,
    film,  // begins a film, or ends it
    wireframe,
    hillShade,
    force,
    statistics,
    pattern,
    help,
    fullScreen,  // done by the rank, whose window it is
    leave,       // closes the help, or asks and then ends. A rank lifts the tool, or leaves full screen, by itself
    quit
};

/// Entry of the list of keys: an action, and the keys that have it.
struct KeyEntry {
    KeyAction action;
    std::span<const base::Keystroke> keys;
    std::string_view effect;    // for people
    bool repeats = false;       // whether a held key acts again
    bool everySession = false;  // whether the keys also act if the hand is no pointer
};

/// Returns all keys that the windows of a wall obey. The master obeys no other key. The help and docs/pointer.md show
/// this list.
[[nodiscard]] std::span<const KeyEntry> keyList();

/// Action of a key, and the place of the key among those with this action.
struct KeyFound {
    const KeyEntry& entry;
    std::size_t index = 0;
};
/// Returns the entry of a key, or nullopt if the key does nothing. A repeated key counts only
/// with KeyEntry::repeats.
[[nodiscard]] std::optional<KeyFound> findKey(base::Keystroke key);
/// Returns whether a key may end the session.
[[nodiscard]] bool isQuitKey(base::Keystroke key);

/// Returns the name of a key as it is on keyboards, such as "Ctrl+Z" or "F1".
[[nodiscard]] std::string keyName(base::Keystroke key);
/// Returns the names of an entry's keys, such as "Ctrl+Z U". The digits of the tools are one name: "1 – 6".
[[nodiscard]] std::string keyNames(const KeyEntry& entry);

/// A use of the mouse, as the help and docs/pointer.md list it.
struct MouseEntry {
    std::string_view input, effect;
};
[[nodiscard]] std::span<const MouseEntry> mouseList();

/// Returns the sentence with which a session with a pointer begins.
[[nodiscard]] std::string hint();

}  // namespace lockstep
