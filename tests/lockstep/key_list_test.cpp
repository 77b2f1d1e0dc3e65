// SPDX-License-Identifier: Apache-2.0
#include "lockstep/key_list.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "sand/model/tool.hpp"

namespace {

using base::Keystroke;
using lockstep::findKey;
using lockstep::KeyAction;
using lockstep::KeyEntry;
using lockstep::keyList;
using lockstep::keyName;
using lockstep::keyNames;

Keystroke press(char code, std::uint8_t modifiers = 0) { return {static_cast<std::uint16_t>(code), modifiers, 0}; }
KeyAction actionOf(Keystroke key) { return findKey(key).value().entry.action; }

TEST(KeyList, HasEachKeyAndEachActionOnce) {
    std::set<std::pair<std::uint16_t, std::uint8_t>> keys;
    std::set<KeyAction> actions;
    for (const KeyEntry& entry : keyList()) {
        EXPECT_TRUE(actions.insert(entry.action).second) << entry.effect;
        ASSERT_FALSE(entry.keys.empty());
        for (const Keystroke key : entry.keys) {
            EXPECT_TRUE(keys.insert({key.code, key.modifiers}).second) << keyName(key);
            EXPECT_EQ(findKey(key)->entry.effect, entry.effect) << keyName(key);
        }
    }
    EXPECT_EQ(actions.size(), static_cast<std::size_t>(KeyAction::quit) + 1);
}

// None of the characters that need AltGr on a German or a French keyboard.
TEST(KeyList, NeedsNoAltGr) {
    constexpr std::string_view kAltGr = "@{}[]\\|~#^`";
    for (const KeyEntry& entry : keyList()) {
        for (const Keystroke key : entry.keys) {
            EXPECT_EQ(key.modifiers & Keystroke::kAlt, 0);
            EXPECT_TRUE(key.code > 126 || kAltGr.find(static_cast<char>(key.code)) == std::string_view::npos)
                << keyName(key);
            EXPECT_TRUE(key.code < 'A' || key.code > 'Z') << "a letter is a small letter, with or without Shift";
        }
    }
}

TEST(KeyList, HasTheHabitsOfDesktops) {
    EXPECT_EQ(actionOf(press('z', Keystroke::kControl)), KeyAction::undo);
    EXPECT_EQ(actionOf(press('z', Keystroke::kControl | Keystroke::kShift)), KeyAction::redo);
    EXPECT_EQ(actionOf(press('y', Keystroke::kControl)), KeyAction::redo);
    EXPECT_EQ(actionOf(press('s', Keystroke::kControl)), KeyAction::save);
    EXPECT_EQ(actionOf(press('q', Keystroke::kControl)), KeyAction::quit);
    EXPECT_EQ(actionOf(press(' ')), KeyAction::pause);
    EXPECT_EQ(actionOf(press('?')), KeyAction::help);
    EXPECT_EQ(actionOf({Keystroke::kF1, 0, 0}), KeyAction::help);
    EXPECT_EQ(actionOf({Keystroke::kF12, 0, 0}), KeyAction::capture);
    EXPECT_EQ(actionOf({Keystroke::kF1 + 8, 0, 0}), KeyAction::film);
    EXPECT_EQ(keyName({Keystroke::kF1 + 8, 0, 0}), "F9");
    EXPECT_EQ(actionOf({Keystroke::kHome, 0, 0}), KeyAction::frameView);
    EXPECT_FALSE(findKey(press('x')));
    EXPECT_FALSE(findKey(press('s', Keystroke::kControl | Keystroke::kShift))) << "another key";
    EXPECT_FALSE(findKey({}));
}

TEST(KeyList, ResetNeedsShift) {
    EXPECT_EQ(actionOf(press('r', Keystroke::kShift)), KeyAction::reset);
    EXPECT_FALSE(findKey(press('r')));
}

TEST(KeyList, LetsAHeldKeyActAgainOnlyWhereThatIsMeant) {
    for (const KeyEntry& entry : keyList()) {
        Keystroke held = entry.keys.front();
        held.repeated = 1;
        EXPECT_EQ(findKey(held).has_value(), entry.repeats) << entry.effect;
    }
    EXPECT_TRUE(findKey(press('+'))->entry.repeats);
    EXPECT_FALSE(findKey(press(' '))->entry.repeats) << "a held key must not pause and resume by turns";
}

TEST(KeyList, NamesKeysAsKeyboardsDo) {
    EXPECT_EQ(keyName(press('z', Keystroke::kControl)), "Ctrl+Z");
    EXPECT_EQ(keyName(press('r', Keystroke::kShift)), "Shift+R");
    EXPECT_EQ(keyName({Keystroke::kF12, 0, 0}), "F12");
    EXPECT_EQ(keyNames(findKey(press('6'))->entry), fmt::format("1 – {}", sand::kToolKinds));
    EXPECT_EQ(findKey(press('6'))->index, 5U);
    EXPECT_EQ(keyNames(findKey(press('h'))->entry), "F1 ? H");
    EXPECT_EQ(keyNames(findKey(press('-'))->entry), "- PgDn");
    EXPECT_EQ(keyNames(findKey(press(' '))->entry), "Space");
}

/// Returns the row of a table in docs/pointer.md.
std::string rowOf(const std::string& names, std::string_view effect) {
    return fmt::format("| {} | {} |\n", names, effect);
}

TEST(KeyList, IsWhatTheDocumentShows) {
    std::string expected;
    for (const lockstep::MouseEntry& entry : lockstep::mouseList()) {
        expected += rowOf(std::string(entry.input), entry.effect);
    }
    for (const KeyEntry& entry : keyList()) {
        std::string names;
        for (const Keystroke key : entry.keys) {
            names += fmt::format("{}`{}`", names.empty() ? "" : " ", keyName(key));
        }
        expected += rowOf(names, entry.effect);
    }
    std::ifstream page(SANDWALL_SOURCE_DIR "/docs/pointer.md");
    const std::string text(std::istreambuf_iterator<char>(page), {});
    EXPECT_NE(text.find("| input | effect |\n|---|---|\n" + expected), std::string::npos)
        << "write this table into docs/pointer.md:\n"
        << expected;
}

TEST(KeyList, KnowsWhatEndsASession) {
    EXPECT_TRUE(lockstep::isQuitKey({Keystroke::kEscape, 0, 0}));
    EXPECT_FALSE(lockstep::isQuitKey(press('q'))) << "it is beside W";
    EXPECT_FALSE(lockstep::findKey(press('q')));
    EXPECT_TRUE(lockstep::isQuitKey(press('q', Keystroke::kControl)));
    EXPECT_FALSE(lockstep::isQuitKey(press('q', Keystroke::kShift)));
    EXPECT_FALSE(lockstep::isQuitKey({}));
}

}  // namespace
