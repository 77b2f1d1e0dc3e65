// SPDX-License-Identifier: Apache-2.0
#include "master/operator/key_commands.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

#include "tests/support/noting_desk.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using base::Keystroke;
using lockstep::KeyAction;
using lockstep::Overlay;
using master::KeyState;
using support::noted;

Keystroke plain(char key) { return {static_cast<std::uint16_t>(key), 0, 0}; }
std::vector<std::string> commandsOf(Keystroke key, const KeyState& state = {}) {
    return master::commandsOf(lockstep::findKey(key).value(), state);
}
std::string commandOf(Keystroke key, const KeyState& state = {}) {
    const std::vector<std::string> commands = commandsOf(key, state);
    EXPECT_EQ(commands.size(), 1U);
    return commands.at(0);
}

TEST(KeyCommands, DigitsChooseTheToolInTheOrderOfItsKinds) {
    char digit = '1';
    for (const std::string_view name : base::namesOf<sand::ToolKind>()) {
        EXPECT_EQ(commandOf(plain(digit++)), "tool " + std::string(name));
    }
    EXPECT_FALSE(lockstep::findKey(plain(digit)));
    EXPECT_EQ(commandOf(plain('3')), "tool rectangle");
}

TEST(KeyCommands, EveryKeyHasOneExceptThoseOfTheView) {
    for (const lockstep::KeyEntry& entry : lockstep::keyList()) {
        const bool ofTheView = entry.action == KeyAction::frameView || entry.action == KeyAction::fullScreen;
        EXPECT_EQ(commandsOf(entry.keys.front()).empty(), ofTheView) << entry.effect;
    }
}

TEST(KeyCommands, EveryLayerHasAKeyThatShowsAndHidesIt) {
    std::set<Overlay> layers;
    for (const lockstep::KeyEntry& entry : lockstep::keyList()) {
        const std::vector<std::string> shows = commandsOf(entry.keys.front());
        if (shows.empty() || !shows[0].starts_with("show ")) {
            continue;
        }
        const Overlay layer = noted(shows[0]).layer;
        KeyState state;
        state.layers.set(layer, true);
        EXPECT_EQ(commandOf(entry.keys.front(), state), "hide " + shows[0].substr(5));
        layers.insert(layer);
    }
    EXPECT_EQ(layers.size(), lockstep::kOverlayNames.size());
}

TEST(KeyCommands, SpacePausesAndResumes) {
    EXPECT_EQ(commandOf(plain(' ')), "pause");
    KeyState paused;
    paused.paused = true;
    EXPECT_EQ(commandOf(plain(' '), paused), "resume");
}

TEST(KeyCommands, ZeroGivesTheToolAndTheHumidityOfTheSceneBack) {
    const scene::Scene scene = samples::flatScene(64, 64);
    for (const sand::ToolKind kind : {sand::ToolKind::sphere, sand::ToolKind::ellipse, sand::ToolKind::footprint}) {
        scene::Material ofScene = scene.material;
        ofScene.toolKind = kind;
        ofScene.leftFoot = kind == sand::ToolKind::footprint;
        ofScene.toolHeading = 30;
        ofScene.humidity = 0.2;
        scene::Material now = scene.material;
        now.toolKind = sand::ToolKind::rectangle;
        now.toolWidth = 0.3;
        now.humidity = 0.9;
        KeyState state;
        state.ofScene = ofScene;
        state.material = now;
        const std::vector<std::string> commands = commandsOf(plain('0'), state);
        ASSERT_EQ(commands.size(), 2U);
        now = scene::withTool(now, noted(commands[0]).tool, scene.grid());
        now = scene::withNumber(now, noted(commands[1]).word, noted(commands[1]).number, scene.grid());
        EXPECT_EQ(scene::tuningOf(now, scene.grid()), scene::tuningOf(ofScene, scene.grid())) << base::nameOf(kind);
    }
}

}  // namespace
