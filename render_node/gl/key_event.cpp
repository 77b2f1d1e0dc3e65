// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/key_event.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <utility>

namespace render_node {
namespace {

using base::Keystroke;

struct NamedKey {
    int key;
    std::uint16_t code;
};
constexpr std::array kNamed{NamedKey{GLFW_KEY_ESCAPE, Keystroke::kEscape}, NamedKey{GLFW_KEY_HOME, Keystroke::kHome},
                            NamedKey{GLFW_KEY_PAGE_UP, Keystroke::kPageUp},
                            NamedKey{GLFW_KEY_PAGE_DOWN, Keystroke::kPageDown}};

std::uint8_t modifiersOf(const KeyEvent& event) {
    unsigned held = 0;
    for (const auto& [bit, ours] :
         {std::pair{GLFW_MOD_SHIFT, Keystroke::kShift}, std::pair{GLFW_MOD_CONTROL, Keystroke::kControl},
          std::pair{GLFW_MOD_ALT, Keystroke::kAlt}, std::pair{GLFW_MOD_SUPER, Keystroke::kSuper}}) {
        held |= (event.modifiers & bit) != 0 ? ours : 0U;
    }
    return static_cast<std::uint8_t>(held);
}

/// Returns the letter at the place of the key on a keyboard of the USA, or 0.
unsigned letterAt(int key) {
    return key >= GLFW_KEY_A && key <= GLFW_KEY_Z ? static_cast<unsigned>(key - GLFW_KEY_A) + 'a' : 0;
}

/// Returns the key for a character and modifiers. Only a letter has Shift as a modifier.
std::optional<Keystroke> keyOf(unsigned character, const KeyEvent& event) {
    if (character >= 127) {
        character = letterAt(event.key);
    }
    if (character >= 'A' && character <= 'Z') {
        character = character - 'A' + 'a';
    }
    if (character < ' ') {
        return std::nullopt;
    }
    unsigned modifiers = modifiersOf(event);
    if (character < 'a' || character > 'z') {
        modifiers &= ~unsigned{Keystroke::kShift};
    }
    return Keystroke{static_cast<std::uint16_t>(character), static_cast<std::uint8_t>(modifiers),
                     static_cast<std::uint8_t>(event.repeated ? 1 : 0)};
}

}  // namespace

std::optional<Keystroke> pressedKey(const KeyEvent& event) {
    const std::uint8_t repeated = event.repeated ? 1 : 0;
    for (const NamedKey& named : kNamed) {
        if (named.key == event.key) {
            return Keystroke{named.code, modifiersOf(event), repeated};
        }
    }
    if (event.key >= GLFW_KEY_F1 && event.key <= GLFW_KEY_F12) {
        return Keystroke{static_cast<std::uint16_t>(Keystroke::kF1 + event.key - GLFW_KEY_F1), modifiersOf(event),
                         repeated};
    }
    if ((event.modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0) {
        return std::nullopt;  // a character follows, if the key types one
    }
    const bool space = event.key == GLFW_KEY_SPACE;
    if (event.name.empty() && !space) {
        return std::nullopt;
    }
    return keyOf(space ? ' ' : static_cast<unsigned char>(event.name.front()), event);
}

std::optional<Keystroke> typedKey(unsigned character, const KeyEvent& event) { return keyOf(character, event); }

}  // namespace render_node
