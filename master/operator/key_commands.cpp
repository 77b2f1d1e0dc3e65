// SPDX-License-Identifier: Apache-2.0
#include "master/operator/key_commands.hpp"

namespace master {
namespace {

using lockstep::KeyAction;
using lockstep::Overlay;

Command toolOf(const scene::ToolChange& change) { return {.verb = Verb::tool, .tool = change}; }

Command humidityOf(double humidity) { return {.verb = Verb::material, .number = humidity, .word = "humidity"}; }

/// Returns the change that gives the scene's tool back, whatever the present tool is.
scene::ToolChange toolOfScene(const scene::Material& scene) {
    std::optional<double> width = scene.toolWidth;
    if (!width && !sand::isRound(scene.toolKind)) {
        width = sand::usualWidth(scene.toolKind);
    }
    return {scene.toolKind, scene.toolRadius, width, scene.toolHeading, scene.leftFoot};
}

Command switched(Overlay layer, const KeyState& state) {
    return {.verb = state.layers.shows(layer) ? Verb::hide : Verb::show, .layer = layer};
}

}  // namespace

std::vector<Command> commandsOf(const lockstep::KeyFound& key, const KeyState& state) {
    const auto resized = [&](double notches) {
        return toolOf({.radius = state.limits.resized(state.material.toolRadius, notches)});
    };
    const auto turnedBy = [&](double degrees) {
        return toolOf({.heading = turned(state.material.toolHeading, degrees)});
    };
    switch (key.entry.action) {
        case KeyAction::tool:
            return {toolOf({.kind = static_cast<sand::ToolKind>(key.index)})};
        case KeyAction::larger:
            return {resized(1)};
        case KeyAction::smaller:
            return {resized(-1)};
        case KeyAction::turnLeft:
            return {turnedBy(kTurnDegrees)};
        case KeyAction::turnRight:
            return {turnedBy(-kTurnDegrees)};
        case KeyAction::sceneTool:
            return {toolOf(toolOfScene(state.ofScene)), humidityOf(state.ofScene.humidity)};
        case KeyAction::wetter:
            return {humidityOf(moistened(state.material.humidity, kMoreHumidity))};
        case KeyAction::drier:
            return {humidityOf(moistened(state.material.humidity, -kMoreHumidity))};
        case KeyAction::undo:
            return {{.verb = Verb::undo}};
        case KeyAction::reset:
            return {{.verb = Verb::reset}};
        case KeyAction::frameView:
        case KeyAction::fullScreen:
            return {};
        case KeyAction::pause:
            return {{.verb = state.paused ? Verb::resume : Verb::pause}};
        case KeyAction::save:
            return {{.verb = Verb::save, .word = state.saveName}};
        case KeyAction::capture:
            return {{.verb = Verb::capture}};
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
            return {{.verb = Verb::pattern}};
        case KeyAction::quit:
            return {{.verb = Verb::stop}};
    }
    return {};
}

}  // namespace master
