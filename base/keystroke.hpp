// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

namespace base {

/// A key that was pressed in a window: its code and the modifiers that were held.
///
/// The code of a key that types a character is that character, as the keyboard's layout has it. A letter is a small
/// letter, and Shift is a modifier. For all other characters Shift belongs to the character, because layouts need it
/// for different ones. Other keys have the codes below.
struct Keystroke {
    static constexpr std::uint8_t kShift = 1, kControl = 2, kAlt = 4, kSuper = 8;
    static constexpr std::uint16_t kEscape = 27;
    static constexpr std::uint16_t kF1 = 0x101, kF11 = 0x10b, kF12 = 0x10c;  // F2 to F10 are between F1 and F11
    static constexpr std::uint16_t kHome = 0x201, kPageUp = 0x202, kPageDown = 0x203;

    std::uint16_t code = 0;  // 0: no key
    std::uint8_t modifiers = 0;
    std::uint8_t repeated = 0;  // 1: the key is held, and the window system repeats it

    /// Returns the press without `repeated`.
    [[nodiscard]] constexpr Keystroke once() const { return {code, modifiers, 0}; }
    friend constexpr bool operator==(const Keystroke&, const Keystroke&) = default;
};
/// Key that stands for the close button of a window, too.
inline constexpr Keystroke kCloseKey{'q', Keystroke::kControl, 0};
static_assert(std::is_trivially_copyable_v<Keystroke> && sizeof(Keystroke) == 4, "part of a message without gaps");

}  // namespace base
