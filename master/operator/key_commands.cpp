// SPDX-License-Identifier: Apache-2.0
#include "master/operator/key_commands.hpp"

#include <fmt/format.h>

namespace master {
namespace {

using haptic_bridge::kDeepest;
using haptic_bridge::kMoreHumidity;
using haptic_bridge::kShallowest;
using haptic_bridge::kTurnDegrees;
using haptic_bridge::moistened;
using haptic_bridge::turned;
using lockstep::KeyAction;
using lockstep::Overlay;

std::string humidityOf(double humidity) { return fmt::format("material humidity {}", humidity); }

/// Returns the command that gives the scene's tool back, whatever the present tool is.
std::string toolOfScene(const scene::Material& scene) {
    std::optional<double> width = scene.toolWidth;
    if (!width && !sand::isRound(scene.toolKind)) {
        width = sand::usualWidth(scene.toolKind);
    }
    return fmt::format("tool {} radius={} heading={} foot={}{}", base::nameOf(scene.toolKind), scene.toolRadius,
                       scene.toolHeading, scene.leftFoot ? "left" : "right",
                       width ? fmt::format(" width={}", *width) : "");
}

std::string switched(Overlay layer, const KeyState& state) {
    return fmt::format("{} {}", state.layers.shows(layer) ? "hide" : "show",
                       lockstep::kOverlayNames.at(static_cast<std::size_t>(layer)));
}

}  // namespace

std::vector<std::string> commandsOf(const lockstep::KeyFound& key, const KeyState& state) {
    const auto resized = [&](double notches) {
        return fmt::format("tool radius={}", state.limits.resized(state.material.toolRadius, notches));
    };
    const auto turnedBy = [&](double degrees) {
        return fmt::format("tool heading={}", turned(state.material.toolHeading, degrees));
    };
    switch (key.entry.action) {
        case KeyAction::tool:
            return {fmt::format("tool {}", base::nameOf(static_cast<sand::ToolKind>(key.index)))};
        case KeyAction::larger:
            return {resized(1)};
        case KeyAction::smaller:
            return {resized(-1)};
        case KeyAction::turn:
            return {turnedBy(key.index == 0 ? kTurnDegrees : -kTurnDegrees)};
        case KeyAction::sceneTool:
            return {toolOfScene(state.ofScene), humidityOf(state.ofScene.humidity)};
        case KeyAction::humidity:
            return {humidityOf(moistened(state.material.humidity, key.index == 0 ? kMoreHumidity : -kMoreHumidity))};
        case KeyAction::undo:
            return {"undo"};
        case KeyAction::redo:
            return {"redo"};
        case KeyAction::reset:
            return {"reset"};
        case KeyAction::frameView:
        case KeyAction::fullScreen:
            return {};
        case KeyAction::pause:
            return {state.paused ? "resume" : "pause"};
        case KeyAction::save:
            return {"save " + state.saveName};
        case KeyAction::capture:
            return {"capture"};
        case KeyAction::film:
            return {"film"};
        case KeyAction::wireframe:
            return {switched(Overlay::wireframe, state)};
        case KeyAction::hillShade:
            return {switched(Overlay::hillShade, state)};
        case KeyAction::force:
            return {switched(Overlay::force, state)};
        case KeyAction::statistics:
            return {switched(Overlay::statistics, state)};
        case KeyAction::help:
            return {switched(Overlay::help, state)};
        case KeyAction::pattern:
            return {"pattern next"};
        case KeyAction::leave:
            return {"hide help"};
        case KeyAction::quit:
            return {"stop"};
    }
    return {};
}

std::string sizeInWords(const KeyState& after) {
    const double radius = after.material.toolRadius;
    const char* end = after.limits.resized(radius, 1) <= radius    ? ", the largest"
                      : after.limits.resized(radius, -1) >= radius ? ", the smallest"
                                                                   : "";
    return fmt::format("radius {:.3g}{}", radius, end);
}

std::string depthInWords(double depth) {
    const char* end = depth >= kDeepest ? ", the deepest" : depth <= kShallowest ? ", the shallowest" : "";
    return fmt::format("depth {:.0f} % of the radius{}", 100 * depth, end);
}

std::string answerOf(const lockstep::KeyFound& key, const KeyState& after) {
    const std::string_view tool = base::nameOf(after.material.toolKind);
    const auto layer = [&](Overlay which) {
        return fmt::format("{} {}", lockstep::kOverlayNames.at(static_cast<std::size_t>(which)),
                           after.layers.shows(which) ? "shown" : "hidden");
    };
    const auto edited = [&](const std::string& words) {
        return words + (after.paused ? "; the sand waits until Space resumes" : "");
    };
    switch (key.entry.action) {
        case KeyAction::tool:
            return edited(fmt::format("tool: {}", tool));
        case KeyAction::larger:
        case KeyAction::smaller:
            return edited(sizeInWords(after));
        case KeyAction::turn:
            return edited(sand::isRound(after.material.toolKind)
                              ? fmt::format("a {} is round: its heading shows in no furrow", tool)
                              : fmt::format("heading {:.0f}°", after.material.toolHeading));
        case KeyAction::sceneTool:
            return edited("tool and humidity of the scene, usual depth");
        case KeyAction::humidity:
            return edited(fmt::format("humidity {:.0f} %", 100 * after.material.humidity));
        case KeyAction::reset:
            return edited("new sand; Ctrl+Z brings yours back");
        case KeyAction::frameView:
            return "the terrain is framed";
        case KeyAction::pause:
            return after.paused ? "paused; Space resumes" : "resumed";
        case KeyAction::wireframe:
            return layer(Overlay::wireframe);
        case KeyAction::hillShade:
            return layer(Overlay::hillShade);
        case KeyAction::force:
            return layer(Overlay::force);
        case KeyAction::statistics:
            return layer(Overlay::statistics);
        case KeyAction::pattern:
            return fmt::format("test pattern: {}", lockstep::patternName(after.pattern));
        case KeyAction::undo:
        case KeyAction::redo:  // answered when the wall shows it
        case KeyAction::save:
        case KeyAction::capture:  // answered when the files are written
        case KeyAction::film:     // answered by the desk
        case KeyAction::help:
        case KeyAction::fullScreen:
        case KeyAction::leave:
        case KeyAction::quit:
            return {};
    }
    return {};
}

}  // namespace master
