// SPDX-License-Identifier: Apache-2.0
#include "lockstep/key_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "sand/model/tool.hpp"

namespace lockstep {
namespace {

using base::Keystroke;

constexpr Keystroke control(char letter) { return {static_cast<std::uint16_t>(letter), Keystroke::kControl, 0}; }
constexpr Keystroke shift(char letter) { return {static_cast<std::uint16_t>(letter), Keystroke::kShift, 0}; }
constexpr Keystroke plain(char character) { return {static_cast<std::uint16_t>(character), 0, 0}; }
constexpr Keystroke named(std::uint16_t code) { return {code, 0, 0}; }

// No key needs AltGr, neither on a German nor on a French keyboard.
constexpr std::array kTools = [] {
    static_assert(sand::kToolKinds <= 9, "each tool has a digit");
    std::array<Keystroke, sand::kToolKinds> digits{};
    std::ranges::generate(digits, [next = '1']() mutable { return plain(next++); });
    return digits;
}();
constexpr std::array kLarger{plain('+'), plain('='),
                             named(Keystroke::kPageUp)};  // = is + without Shift on many keyboards
constexpr std::array kSmaller{plain('-'), named(Keystroke::kPageDown)};
constexpr std::array kTurn{plain(','), plain('.')};
constexpr std::array kScene{plain('0')};
constexpr std::array kHumidity{plain('w'), plain('d')};
constexpr std::array kUndo{control('z'), plain('u')};
constexpr std::array kRedo{control('y'),
                           Keystroke{'z', static_cast<std::uint8_t>(Keystroke::kControl | Keystroke::kShift), 0}};
constexpr std::array kReset{shift('r')};
constexpr std::array kFrame{named(Keystroke::kHome), plain('v')};
constexpr std::array kPause{plain(' ')};
constexpr std::array kSave{control('s')};
constexpr std::array kCapture{named(Keystroke::kF12)};
constexpr std::array kFilm{named(Keystroke::kF1 + 8)};
constexpr std::array kWireframe{plain('g')}, kHillShade{plain('m')}, kForce{plain('f')}, kStatistics{plain('s')};
constexpr std::array kPattern{plain('t')};
constexpr std::array kFullScreen{named(Keystroke::kF11)};
constexpr std::array kHelp{named(Keystroke::kF1), plain('?'), plain('h')};
constexpr std::array kLeave{named(Keystroke::kEscape)};
constexpr std::array kQuit{base::kCloseKey};

constexpr std::array<KeyEntry, 23> kKeys{{{KeyAction::tool, kTools, "chooses the tool"},
                                          {KeyAction::larger, kLarger, "larger tool", true},
                                          {KeyAction::smaller, kSmaller, "smaller tool", true},
                                          {KeyAction::turn, kTurn, "turns the tool", true},
                                          {KeyAction::sceneTool, kScene, "tool of the scene"},
                                          {KeyAction::humidity, kHumidity, "wetter, drier sand", true},
                                          {KeyAction::undo, kUndo, "undoes"},
                                          {KeyAction::redo, kRedo, "redoes"},
                                          {KeyAction::reset, kReset, "new sand"},
                                          {KeyAction::frameView, kFrame, "frames the terrain"},
                                          {KeyAction::pause, kPause, "pauses or resumes"},
                                          {KeyAction::save, kSave, "saves the sand"},
                                          {KeyAction::capture, kCapture, "saves a picture"},
                                          {KeyAction::film, kFilm, "begins, ends a film", false, true},
                                          {KeyAction::wireframe, kWireframe, "wireframe"},
                                          {KeyAction::hillShade, kHillShade, "hill-shade"},
                                          {KeyAction::force, kForce, "force as an arrow"},
                                          {KeyAction::statistics, kStatistics, "statistics"},
                                          {KeyAction::pattern, kPattern, "next test pattern", false, true},
                                          {KeyAction::help, kHelp, "this help"},
                                          {KeyAction::fullScreen, kFullScreen, "full screen, and back", false, true},
                                          {KeyAction::leave, kLeave, "leaves; twice: ends", false, true},
                                          {KeyAction::quit, kQuit, "ends the session", false, true}}};

constexpr std::array<MouseEntry, 5> kMouse{{{"left button", "digs"},
                                            {"wheel", "zooms, or sets depth"},
                                            {"Shift, Ctrl+wheel", "depth, size of the tool"},
                                            {"right button", "turns the sand"},
                                            {"middle, Shift+right", "moves the sand"}}};

}  // namespace

std::span<const KeyEntry> keyList() { return kKeys; }

std::span<const MouseEntry> mouseList() { return kMouse; }

std::optional<KeyFound> findKey(base::Keystroke key) {
    for (const KeyEntry& entry : kKeys) {
        const auto found = std::ranges::find(entry.keys, key.once());
        if (found != entry.keys.end()) {
            if (key.repeated != 0 && !entry.repeats) {
                return std::nullopt;
            }
            return KeyFound{entry, static_cast<std::size_t>(found - entry.keys.begin())};
        }
    }
    return std::nullopt;
}

bool isQuitKey(base::Keystroke key) { return key.once() == kLeave.front() || key.once() == kQuit.front(); }

std::string hint() {
    return fmt::format("Dig with the left button · {} shows all keys · {} ends", keyName(kHelp.front()),
                       keyName(kQuit.front()));
}

std::string keyName(base::Keystroke key) {
    std::string name;
    for (const auto& [bit, word] : {std::pair{Keystroke::kControl, "Ctrl+"}, std::pair{Keystroke::kAlt, "Alt+"},
                                    std::pair{Keystroke::kShift, "Shift+"}}) {
        name += (key.modifiers & bit) != 0 ? word : "";
    }
    switch (key.code) {
        case ' ':
            return name + "Space";
        case Keystroke::kEscape:
            return name + "Esc";
        case Keystroke::kHome:
            return name + "Home";
        case Keystroke::kPageUp:
            return name + "PgUp";
        case Keystroke::kPageDown:
            return name + "PgDn";
        default:
            break;
    }
    if (key.code >= Keystroke::kF1 && key.code <= Keystroke::kF12) {
        return fmt::format("{}F{}", name, key.code - Keystroke::kF1 + 1);
    }
    const auto character = static_cast<char>(key.code);
    const bool letter = character >= 'a' && character <= 'z';
    name += letter ? static_cast<char>(character - 'a' + 'A') : character;
    return name;
}

std::string keyNames(const KeyEntry& entry) {
    if (entry.action == KeyAction::tool) {
        return fmt::format("{} – {}", keyName(entry.keys.front()), keyName(entry.keys.back()));
    }
    std::string names;
    for (const base::Keystroke key : entry.keys) {
        names += fmt::format("{}{}", names.empty() ? "" : " ", keyName(key));
    }
    return names;
}

}  // namespace lockstep
