// SPDX-License-Identifier: Apache-2.0
#include "master/operator/pointer_keys.hpp"

#include <gtest/gtest.h>

#include "master/operator/operator_command.hpp"

namespace {

using master::commandOf;

TEST(PointerKeys, DigitsChooseTheToolInTheOrderOfItsKinds) {
    EXPECT_EQ(commandOf('1', {}, {}), "tool sphere");
    EXPECT_EQ(commandOf('3', {}, {}), "tool rectangle");
    EXPECT_EQ(commandOf('6', {}, {}), "tool footprint");
    EXPECT_EQ(commandOf('7', {}, {}), "");
    EXPECT_EQ(commandOf('0', {}, {}), "");
}

TEST(PointerKeys, HumidityStaysWithinItsRange) {
    scene::Material material;
    EXPECT_EQ(commandOf('w', material, {}), "material humidity 0.1");
    EXPECT_EQ(commandOf('d', material, {}), "material humidity 0");
    material.humidity = 0.95;
    EXPECT_EQ(commandOf('w', material, {}), "material humidity 1");
}

TEST(PointerKeys, LargerAndSmallerCancelOut) {
    scene::Material material;
    material.toolRadius = 0.04;
    EXPECT_EQ(commandOf('+', material, {}), "tool radius=0.05");
    EXPECT_EQ(commandOf('-', material, {}), "tool radius=0.032");
}

TEST(PointerKeys, ALayerIsShownAndHiddenByTheSameKey) {
    lockstep::Overlays layers;
    EXPECT_EQ(commandOf('h', {}, layers), "show help");
    layers.set(lockstep::Overlay::help, true);
    EXPECT_EQ(commandOf('h', {}, layers), "hide help");
    EXPECT_EQ(commandOf('m', {}, layers), "show hill-shade");
}

TEST(PointerKeys, EveryCommandIsOneThatOperatorsHave) {
    int commands = 0;
    for (char key = ' '; key < 127; ++key) {
        if (const std::string command = commandOf(key, {}, {}); !command.empty()) {
            EXPECT_NO_THROW((void)master::parseCommand(command)) << command;
            ++commands;
        }
    }
    EXPECT_EQ(commands, 6 + 5 + 3 + 2 + 2);
}

TEST(PointerKeys, ResetNeedsShiftBecauseItCannotBeUndone) {
    EXPECT_EQ(commandOf('R', {}, {}), "reset");
    EXPECT_EQ(commandOf('r', {}, {}), "");
}

}  // namespace
